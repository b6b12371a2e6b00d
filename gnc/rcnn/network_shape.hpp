// The sizes of the RCNN, once: the flight network, the trainer and the model image all read them here.
#pragma once

namespace tumblesight::gnc::shape {

inline constexpr int kImageSide = 100;
// Backbone: space-to-depth 2x2, then four 3x3 convolutions (zero padding 1), each with bias; the first three
// are followed by max-pooling 2x2 (floor) and ReLU, the last by ReLU and average pooling 2x2.
inline constexpr int kSpaceToDepthChannels = 4;  // channel = 2 * (row & 1) + (column & 1)
inline constexpr int kConv1 = 32;                // 50x50 -> 25x25
inline constexpr int kConv2 = 64;                // 25x25 -> 12x12
inline constexpr int kConv3 = 128;               // 12x12 -> 6x6
inline constexpr int kConv4 = 240;               // 6x6   -> 3x3
inline constexpr int kFlat = 3 * 3 * kConv4;
inline constexpr int kDense1 = 192;  // ReLU
inline constexpr int kDense2 = 128;  // ReLU

// Output of the single-frame head: kHypotheses attitudes as two unnormalised columns of R_view_trf (six
// numbers each), their logits, and the logit of the expected error over pi.
inline constexpr int kHypotheses = 8;
inline constexpr int kColumns = 6 * kHypotheses;
inline constexpr int kOutput = kColumns + kHypotheses + 1;

// LSTM input: Dense2's output; two columns of every hypothesis relative to the predicted attitude; the
// softmax probabilities; two columns of the predicted attitude.
inline constexpr int kLstmInput = kDense2 + kColumns + kHypotheses + 6;
inline constexpr int kLstm = 192;
// Recurrent head: Dense(ReLU) over [LSTM hidden, LSTM input], then a Dense whose output corrects, for the
// kHypotheses candidates of the frame and the predicted one: the logits of choosing them, then the logarithms
// of their weights; then the rate's gain; last, the logit of the expected error over pi.
inline constexpr int kHead = 128;
inline constexpr int kCandidates = kHypotheses + 1;
inline constexpr int kHeadOutput = 2 * kCandidates + 2;

}  // namespace tumblesight::gnc::shape
