// SpaceToDepth: every 2x2 pixels of a one-channel image become one pixel of four channels.
#pragma once

#include <array>

namespace tumblesight::gnc {

template <int kSide>
struct SpaceToDepth {
  static_assert(kSide % 2 == 0);
  static constexpr int kSideOut = kSide / 2;
  using Input = std::array<float, kSide * kSide>;
  using Output = std::array<float, kSideOut * kSideOut * 4>;

  // Channel = 2 * (row & 1) + (column & 1).
  static void forward(const Input& in, Output& out) {
    for (int y = 0; y < kSideOut; ++y) {
      for (int x = 0; x < kSideOut; ++x) {
        const int from = 2 * y * kSide + 2 * x;
        const int to = (y * kSideOut + x) * 4;
        out[to] = in[from];
        out[to + 1] = in[from + 1];
        out[to + 2] = in[from + kSide];
        out[to + 3] = in[from + kSide + 1];
      }
    }
  }
};

}  // namespace tumblesight::gnc
