#include "gnc/nn/activation.hpp"

#include <cstdint>
#include <cstring>

#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {
namespace {

// NaN gives -bound.
inline float clamp_symmetric(float x, float bound) {
  return clamp(x, -bound, bound);
}

// e^x = 2^n e^r with n = round(x / ln 2), |r| <= ln(2) / 2, and e^r = 1 + r + r^2 q(r).
inline float exp_scalar(float argument) {
  constexpr float kLog2OfE = 1.44269504F;
  constexpr float kRound = 12582912.0F;       // 1.5 * 2^23: adding and subtracting it rounds to an integer
  constexpr float kLn2High = 0.693359375F;    // few enough bits for n times it to be exact
  constexpr float kLn2Low = -2.12194440e-4F;  // ln 2 - kLn2High
  // Minimax fit over +-ln(2)/2; relative error of e^r 3e-9 before rounding.
  constexpr float kQ0 = 0.49999994F;
  constexpr float kQ1 = 0.166665211F;
  constexpr float kQ2 = 0.041668389F;
  constexpr float kQ3 = 0.00836871658F;
  constexpr float kQ4 = 0.00138145988F;

  const float x = clamp_symmetric(argument, kExpArgumentBound);
  const float n = (x * kLog2OfE + kRound) - kRound;
  const float r = (x - n * kLn2High) - n * kLn2Low;
  const float q = kQ0 + r * (kQ1 + r * (kQ2 + r * (kQ3 + r * kQ4)));
  const float e_r = 1.0F + (r + r * r * q);
  const std::uint32_t exponent = static_cast<std::uint32_t>(static_cast<std::int32_t>(n) + 127) << 23;
  float two_to_n = 0.0F;
  std::memcpy(&two_to_n, &exponent, sizeof two_to_n);
  return e_r * two_to_n;
}

inline float sigmoid_scalar(float x) {
  return 1.0F / (1.0F + exp_scalar(-x));
}

}  // namespace

void exp(const float* in, float* out, int count) {
  for (int i = 0; i < count; ++i) out[i] = exp_scalar(in[i]);
}

void sigmoid(const float* in, float* out, int count) {
  for (int i = 0; i < count; ++i) out[i] = sigmoid_scalar(in[i]);
}

void tanh(const float* in, float* out, int count) {
  for (int i = 0; i < count; ++i) out[i] = 2.0F * sigmoid_scalar(2.0F * in[i]) - 1.0F;
}

float sigmoid(float x) {
  return sigmoid_scalar(x);
}

float exp(float x) {
  return exp_scalar(x);
}

}  // namespace tumblesight::gnc
