#include "gnc/nn/padding.hpp"

#include <algorithm>

namespace tumblesight::gnc {

void pad_by_one(const float* in, int side, int channels, float* out) {
  const int row = side * channels;
  out = std::fill_n(out, row + 2 * channels, 0.0F);
  for (int y = 0; y < side; ++y) {
    out = std::fill_n(out, channels, 0.0F);
    out = std::copy_n(in + y * row, row, out);
    out = std::fill_n(out, channels, 0.0F);
  }
  std::fill_n(out, row + 2 * channels, 0.0F);
}

}  // namespace tumblesight::gnc
