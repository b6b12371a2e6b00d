// The operations of the attitude algebra, for Real = float and Real = Fixed, so that the algebra is written
// once. Vectors and matrices are Eigen's. The operations here fix the order of summation, the rounding and
// the degenerate cases of each number type.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "gnc/numerics/fixed.hpp"
#include "gnc/numerics/functions.hpp"

namespace Eigen {
template <>
struct NumTraits<tumblesight::gnc::Fixed> : GenericNumTraits<tumblesight::gnc::Fixed> {
  using Real = tumblesight::gnc::Fixed;
  using NonInteger = Real;
  using Nested = Real;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 1,
    AddCost = 2,
    MulCost = 4
  };
};
}  // namespace Eigen

namespace tumblesight::gnc {

template <class Real>
using Vector3 = Eigen::Matrix<Real, 3, 1>;
template <class Real>
using Matrix3 = Eigen::Matrix<Real, 3, 3>;

// A compile-time constant, rounded to Real.
template <class Real>
constexpr Real constant(double value) {
  return static_cast<Real>(value);
}

inline constexpr double kPi = 3.14159265358979323846;

// a0 b0 + a1 b1 + a2 b2: in float summed from left to right, in fixed point rounded once at the end.
inline float sum_of_products(float a0, float b0, float a1, float b1, float a2, float b2) {
  return (a0 * b0 + a1 * b1) + a2 * b2;
}
inline Fixed sum_of_products(Fixed a0, Fixed b0, Fixed a1, Fixed b1, Fixed a2, Fixed b2) {
  return Fixed::dot(a0, b0, a1, b1, a2, b2);
}
// Dot product of two vectors, rows or columns of three elements.
template <class A, class B>
typename A::Scalar dot(const A& a, const B& b) {
  return sum_of_products(a(0), b(0), a(1), b(1), a(2), b(2));
}

// v times factor.
template <class Real>
Vector3<Real> scaled(const Vector3<Real>& v, Real factor) {
  return {v.x() * factor, v.y() * factor, v.z() * factor};
}

// v / |v|; the zero vector stays zero. Float: squared lengths below 1e-12 are raised to 1e-12. Fixed: the
// vector is first scaled to 30 bits, so that short vectors keep their precision; error at most 2^-24 per
// element.
inline Vector3<float> normalized(const Vector3<float>& v) {
  constexpr float kSmallest = 1e-12F;
  const float square = dot(v, v);
  const float length = std::sqrt(max(square, kSmallest));
  return {v.x() / length, v.y() / length, v.z() / length};
}
Vector3<Fixed> normalized(const Vector3<Fixed>& v);

// Neither NaN nor infinite; always true for Fixed.
inline bool is_finite(float x) {
  return std::isfinite(x);
}
inline bool is_finite(Fixed) {
  return true;
}

// Absolute value; integers: select.hpp.
inline float abs(float x) {
  return std::abs(x);
}
inline Fixed abs(Fixed x) {
  return select(x < Fixed(), -x, x);
}

}  // namespace tumblesight::gnc
