// gnc/rcnn/hypotheses.hpp and attitude_track.hpp in ONNX. The flight code gives the same values
// (tests/unit/sim/bench/step_model_test.cpp). Left out are its repairs of a damaged state: an attitude that
// is no rotation, numbers that are not finite.
//
// Shapes as in rotation_graph.hpp; 8 hypotheses, 9 candidates, 5 motion models. A truth value is [1, 1, 1].
#pragma once

#include "gnc/rcnn/attitude_track.hpp"
#include "sim/onnx/onnx_tensor.hpp"
#include "sim/onnx/rotation_graph.hpp"

namespace tumblesight::sim {

struct HypothesesGraph {
  OnnxTensor r_lrf_trf;      // [8, 3, 3]
  OnnxTensor logits;         // [1, 8]
  OnnxTensor probabilities;  // [1, 8]
  OnnxTensor likeliest;      // [1, 3, 3]: of r_lrf_trf
};
// From the output of the CNN.
HypothesesGraph decoded_hypotheses(const OnnxTensor& cnn_output, const OnnxTensor& r_lrf_view);

// What is carried from frame to frame, beside the LSTM's state. All zero before the first frame.
struct TrackGraph {
  MotionGraph motion;         // of each motion model, K = 5
  OnnxTensor log_likelihood;  // [5, 1, 1]
  OnnxTensor frames;          // [1, 1, 1]: since the track began
  OnnxTensor has_found_rate;  // [1, 1, 1]: 1 if the last two frames were close enough in time to tell it
};

struct IntervalGraph {
  OnnxTensor elapsed_s;   // [1, 1, 1]: since the last frame
  OnnxTensor r_now_last;  // [1, 3, 3]: turn of the chaser
};

struct PredictionGraph {
  TrackGraph track;        // motion: at this frame; all else: before it
  OnnxTensor r_lrf_trf;    // [1, 3, 3]: of the motion model that gives the result
  OnnxTensor periods;      // [1, 1, 1]: since the last frame
  OnnxTensor starts_anew;  // the state of the LSTM must be reset: gnc::keep_confirmed() is false
};
// AttitudeTrack::forget_rate(), predict() and keep_confirmed() of the flight code. What FrameTracker tells
// the estimator about the rate, from which keep_confirmed() follows, is found here from `has_found_rate`.
PredictionGraph predicted(const TrackGraph& track, const gnc::MotionModels<float>& motion_models,
                          const HypothesesGraph& hypotheses, const IntervalGraph& interval);

OnnxTensor lstm_input(const OnnxTensor& features, const HypothesesGraph& hypotheses,
                      const PredictionGraph& prediction);

struct TrackedGraph {
  TrackGraph track;
  MotionGraph motion;             // the result, K = 1
  OnnxTensor expected_error_rad;  // [1, 1]
};
TrackedGraph advanced(const HypothesesGraph& hypotheses, const PredictionGraph& prediction,
                      const OnnxTensor& head_output);

}  // namespace tumblesight::sim
