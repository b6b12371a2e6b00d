// Activation functions in float32, element by element, without libm: the bits are the same on every
// processor.
#pragma once

namespace tumblesight::gnc {

// in, out: `count` elements; `out` may be `in`.
//
// Largest errors over all finite arguments, checked by a unit test: exp 2e-7 relative, sigmoid 1.5e-7 and
// tanh 3e-7 absolute. Every result is finite, also for infinities and NaN: the argument of exp is limited to
// +-kExpArgumentBound, where neither the result nor its reciprocal is subnormal, and NaN counts as the lower
// bound.
inline constexpr float kExpArgumentBound = 86.0F;
void exp(const float* in, float* out, int count);
void sigmoid(const float* in, float* out, int count);  // 1 / (1 + e^-x)
void tanh(const float* in, float* out, int count);
float sigmoid(float x);
float exp(float x);

}  // namespace tumblesight::gnc
