// Activation functions, elementwise over arrays, without libm: the same bits on every processor.
#pragma once

namespace tumblesight::gnc {

// Largest errors against exact values, over all finite arguments (a unit test sweeps them): exp 2e-7
// relative, sigmoid 1.5e-7 and tanh 3e-7 absolute. Every result is finite, for infinities and NaN too:
// arguments of exp are held within +-kExpArgumentBound, where neither it nor its reciprocal is subnormal, and
// NaN counts as the lower bound. `out` may be `in`.
inline constexpr float kExpArgumentBound = 86.0F;
void exp(const float* in, float* out, int count);
void sigmoid(const float* in, float* out, int count);
void tanh(const float* in, float* out, int count);
float sigmoid(float x);
float exp(float x);

}  // namespace tumblesight::gnc
