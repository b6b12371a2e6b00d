#include "gnc/nn/pooling.hpp"

namespace tumblesight::gnc {
namespace {

inline float larger(float a, float b) {
  return a > b ? a : b;
}

}  // namespace

void max_pool_2x2(const float* in, int side, int channels, float* __restrict out) {
  const int row = side * channels;
  for (int y = 0; y + 1 < side; y += 2) {
    for (int x = 0; x + 1 < side; x += 2) {
      const float* top = in + y * row + x * channels;
      const float* bottom = top + row;
      for (int c = 0; c < channels; ++c) {
        out[c] = larger(larger(top[c], top[channels + c]), larger(bottom[c], bottom[channels + c]));
      }
      out += channels;
    }
  }
}

void average_pool(const float* in, int side, int channels, int window, float* __restrict out) {
  const int row = side * channels;
  const float count = static_cast<float>(window * window);
  for (int y = 0; y + window <= side; y += window) {
    for (int x = 0; x + window <= side; x += window) {
      const float* corner = in + y * row + x * channels;
      for (int c = 0; c < channels; ++c) {
        float sum = 0.0F;
        for (int i = 0; i < window * window; ++i)
          sum += corner[(i / window) * row + (i % window) * channels + c];
        out[c] = sum / count;
      }
      out += channels;
    }
  }
}

}  // namespace tumblesight::gnc
