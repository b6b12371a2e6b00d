// Pooling over a square HWC image. Rows and columns that fill no whole window are left out (floor).
#pragma once

#include <array>

namespace tumblesight::gnc {

void max_pool_2x2(const float* in, int side, int channels, float* out);
// Mean of window x window pixels, added row by row from the top left.
void average_pool(const float* in, int side, int channels, int window, float* out);

template <int kSide, int kChannels>
struct MaxPool2x2 {
  static constexpr int kSideOut = kSide / 2;
  using Input = std::array<float, kSide * kSide * kChannels>;
  using Output = std::array<float, kSideOut * kSideOut * kChannels>;
  static void forward(const Input& in, Output& out) { max_pool_2x2(in.data(), kSide, kChannels, out.data()); }
};

template <int kSide, int kChannels, int kWindow>
struct AveragePool {
  static constexpr int kSideOut = kSide / kWindow;
  using Input = std::array<float, kSide * kSide * kChannels>;
  using Output = std::array<float, kSideOut * kSideOut * kChannels>;
  static void forward(const Input& in, Output& out) {
    average_pool(in.data(), kSide, kChannels, kWindow, out.data());
  }
};

template <int kSide, int kChannels>
using GlobalAveragePool = AveragePool<kSide, kChannels, kSide>;

}  // namespace tumblesight::gnc
