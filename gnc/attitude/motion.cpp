#include "gnc/attitude/motion.hpp"

#include "gnc/numerics/division.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kSteps = 4;  // of the midpoint method per nominal period or part of it

// A time as a number of equal parts, none longer than a nominal period.
struct TimeSplit {
  int parts;
  Fixed part;  // [nominal periods]
};

TimeSplit split(std::int64_t elapsed_ns) {
  const std::int64_t time_ns = clamp<std::int64_t>(elapsed_ns, 0, kLongestPropagation_ns);
  const std::int64_t parts = max<std::int64_t>(1, divide(time_ns + kNominalPeriod_ns - 1, kNominalPeriod_ns));
  const std::int64_t divisor = parts * kNominalPeriod_ns;
  const std::int64_t raw = divide(time_ns * (std::int64_t{1} << Fixed::kFractionBits) + divisor / 2, divisor);
  return {static_cast<int>(parts), Fixed::from_raw(raw)};
}

// The rate limited to kLargestRate. Float: a vector whose squared length overflows becomes zero.
template <class Real>
Vector3<Real> clamp_length(const Vector3<Real>& rate) {
  constexpr Real kLargest = constant<Real>(static_cast<double>(kLargestRate));
  const bool too_long = dot(rate, rate) > kLargest * kLargest;
  const Vector3<Real> shortened = scaled<Real>(normalized(rate), kLargest);
  return {select(too_long, shortened.x(), rate.x()), select(too_long, shortened.y(), rate.y()),
          select(too_long, shortened.z(), rate.z())};
}

// Angular rate in the LRF of a body with this inertia and the angular momentum `momentum_lrf`.
template <class Real>
Vector3<Real> rate_from_momentum(const Matrix3<Real>& r_lrf_trf, const Vector3<Real>& momentum_lrf,
                                 const Inertia<Real>& inertia) {
  const Vector3<Real> momentum_trf = transpose_product<Real>(r_lrf_trf, momentum_lrf);
  return product<Real>(r_lrf_trf, product<Real>(inertia.inverse_trf, momentum_trf));
}

// 1 - x k_0 (1 - x k_1 (1 - ...)): an alternating power series, given by the ratios of consecutive
// coefficients.
template <class Real, std::size_t kTerms>
Real alternating_series(Real x, const std::array<Real, kTerms>& ratio) {
  constexpr Real kOne = constant<Real>(1.0);
  Real sum = kOne;
  for (std::size_t k = kTerms; k-- > 0;) sum = kOne - x * ratio[k] * sum;
  return sum;
}

template <class Real>
Matrix3<Real> scaled(const Matrix3<Real>& matrix, Real factor) {
  Matrix3<Real> result;
  for (int column = 0; column < 3; ++column)
    result.col(column) = gnc::scaled<Real>(Vector3<Real>(matrix.col(column)), factor);
  return result;
}

// Adjugate: the inverse times the determinant.
template <class Real>
Matrix3<Real> adjugate(const Matrix3<Real>& j) {
  Matrix3<Real> result;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      result(k, i) = j(i1, k1) * j(i2, k2) - j(i1, k2) * j(i2, k1);
    }
  }
  return result;
}

// Of a rotation vector not longer than kLargestRate.
template <class Real>
Matrix3<Real> rotation_from_short_vector(const Vector3<Real>& v) {
  // sin(a) / a and (1 - cos(a)) / a^2 as Taylor series in a^2.
  constexpr std::array<Real, 6> kSine{constant<Real>(1.0 / 6.0),   constant<Real>(1.0 / 20.0),
                                      constant<Real>(1.0 / 42.0),  constant<Real>(1.0 / 72.0),
                                      constant<Real>(1.0 / 110.0), constant<Real>(1.0 / 156.0)};
  constexpr std::array<Real, 6> kCosine{constant<Real>(1.0 / 12.0),  constant<Real>(1.0 / 30.0),
                                        constant<Real>(1.0 / 56.0),  constant<Real>(1.0 / 90.0),
                                        constant<Real>(1.0 / 132.0), constant<Real>(1.0 / 182.0)};
  const Real s = dot(v, v);
  const Real a = alternating_series<Real>(s, kSine);
  const Real b = constant<Real>(0.5) * alternating_series<Real>(s, kCosine);
  const Real c = constant<Real>(1.0) - b * s;
  Matrix3<Real> r;
  r << c + b * v.x() * v.x(), b * v.x() * v.y() - a * v.z(), b * v.x() * v.z() + a * v.y(),
      b * v.x() * v.y() + a * v.z(), c + b * v.y() * v.y(), b * v.y() * v.z() - a * v.x(),
      b * v.x() * v.z() - a * v.y(), b * v.y() * v.z() + a * v.x(), c + b * v.z() * v.z();
  return r;
}

// The turn of a step, with every element limited so that its length is at most kLargestRate. Cheaper than
// clamp_length(), and no limit to a turn below 60 degrees: a step of the fastest rate turns by 27 degrees,
// unless the moments of inertia differ by more than a factor of two.
template <class Real>
Matrix3<Real> rotation_of_step(const Vector3<Real>& turn) {
  constexpr Real kLargest = constant<Real>(static_cast<double>(kLargestRate) * 0.577);
  return rotation_from_short_vector<Real>({clamp(turn.x(), -kLargest, kLargest),
                                           clamp(turn.y(), -kLargest, kLargest),
                                           clamp(turn.z(), -kLargest, kLargest)});
}

// 1 - cos(angle) of a rotation.
template <class Real>
Real versine_of(const Matrix3<Real>& r) {
  const Real trace = (r(0, 0) + r(1, 1)) + r(2, 2);
  return constant<Real>(0.5) * (constant<Real>(3.0) - trace);
}

// angle / sin(angle) as a power series in y = 1 - cos(angle); the ratio of consecutive coefficients is
// n / (2n + 1).
template <class Real>
Real angle_over_sine(Real y) {
  Real f = constant<Real>(1.0);
  constexpr std::array<Real, 8> kRatio{constant<Real>(1.0 / 3.0),  constant<Real>(2.0 / 5.0),
                                       constant<Real>(3.0 / 7.0),  constant<Real>(4.0 / 9.0),
                                       constant<Real>(5.0 / 11.0), constant<Real>(6.0 / 13.0),
                                       constant<Real>(7.0 / 15.0), constant<Real>(8.0 / 17.0)};
  for (std::size_t k = kRatio.size(); k-- > 0;) f = constant<Real>(1.0) + y * kRatio[k] * f;
  return f;
}

}  // namespace

template <class Real>
bool make_inertia(const Matrix3<Real>& tensor_trf, Inertia<Real>& inertia) {
  constexpr Real kZero{};
  const Matrix3<Real>& given = tensor_trf;
  const Real trace = (given(0, 0) + given(1, 1)) + given(2, 2);
  const bool symmetric =
      given(0, 1) == given(1, 0) && given(0, 2) == given(2, 0) && given(1, 2) == given(2, 1);
  if (!is_finite(trace) || !(trace > kZero) || !symmetric) return false;

  const Matrix3<Real> j = scaled<Real>(given, constant<Real>(3.0) / trace);
  const Matrix3<Real> scaled_inverse = adjugate<Real>(j);
  const Real determinant =
      (j(0, 0) * scaled_inverse(0, 0) + j(0, 1) * scaled_inverse(1, 0)) + j(0, 2) * scaled_inverse(2, 0);
  // Positive definite if all leading minors are positive (Sylvester). The trace of the inverse bounds its
  // largest eigenvalue, and so the smallest moment.
  const Real inverse_trace = (scaled_inverse(0, 0) + scaled_inverse(1, 1)) + scaled_inverse(2, 2);
  const bool definite = j(0, 0) > kZero && scaled_inverse(2, 2) > kZero && determinant > kZero;
  if (!definite || !(constant<Real>(kSmallestMoment) * inverse_trace < determinant)) return false;
  inertia.tensor_trf = j;
  for (int i = 0; i < 9; ++i) inertia.inverse_trf(i) = scaled_inverse(i) / determinant;
  return true;
}

template <class Real>
Matrix3<Real> rotation_from_vector(const Vector3<Real>& turn) {
  return rotation_from_short_vector<Real>(clamp_length<Real>(turn));
}

template <class Real>
Vector3<Real> small_rotation_vector(const Matrix3<Real>& r) {
  constexpr Real kHalf = constant<Real>(0.5);
  const Real y = versine_of<Real>(r);
  const Real half = select(y < kHalf, kHalf * angle_over_sine<Real>(y), Real{});  // below 60 degrees
  return {half * (r(2, 1) - r(1, 2)), half * (r(0, 2) - r(2, 0)), half * (r(1, 0) - r(0, 1))};
}

template <class Real>
Vector3<Real> rotation_vector(const Matrix3<Real>& r, Real largest_versine) {
  constexpr Real kOne = constant<Real>(1.0);
  const Vector3<Real> small = small_rotation_vector<Real>(r);
  // (angle / 2) / sin(angle / 2) as the same power series, in 1 - cos(angle / 2).
  const QuaternionQ30 q = quaternion_from_rotation(converted<Fixed>(r));
  std::array<Real, 4> half;
  for (std::size_t i = 0; i < 4; ++i)
    half[i] = converted<Real>(Fixed::from_raw((static_cast<std::int64_t>(q[i]) + (1 << 5)) >> 6));
  const Real factor = constant<Real>(2.0) * angle_over_sine<Real>(kOne - half[0]);
  const Real versine = versine_of<Real>(r);
  const bool is_small = versine < constant<Real>(kVersineOf60Degrees);
  const bool is_large = !is_small & (versine < constant<Real>(kVersineOf150Degrees));
  const bool is_accepted = versine < largest_versine;
  Vector3<Real> turn;
  for (int i = 0; i < 3; ++i) {
    const Real large = select(is_large, factor * half[static_cast<std::size_t>(i) + 1], Real{});
    turn[i] = select(is_accepted, select(is_small, small[i], large), Real{});
  }
  return turn;
}

Fixed in_periods(std::int64_t elapsed_ns) {
  const TimeSplit time = split(elapsed_ns);
  return Fixed::from_raw(std::int64_t{time.part.raw()} * time.parts);
}

template <class Real>
Motion<Real> propagate(const Motion<Real>& motion, const Inertia<Real>& inertia, std::int64_t elapsed_ns) {
  const TimeSplit time = split(elapsed_ns);
  const Real step = constant<Real>(1.0 / kSteps) * converted<Real>(time.part);
  const Real half_step = constant<Real>(0.5 / kSteps) * converted<Real>(time.part);
  const Vector3<Real> rate = clamp_length<Real>(motion.rate_lrf);
  const Vector3<Real> rate_trf = transpose_product<Real>(motion.r_lrf_trf, rate);
  const Vector3<Real> momentum_lrf =
      product<Real>(motion.r_lrf_trf, product<Real>(inertia.tensor_trf, rate_trf));
  Matrix3<Real> r = motion.r_lrf_trf;
  for (int i = 0; i < kSteps * kMaxPeriods; ++i) {
    if (i == kSteps * time.parts) break;
    const Vector3<Real> half_turn =
        gnc::scaled<Real>(rate_from_momentum<Real>(r, momentum_lrf, inertia), half_step);
    const Matrix3<Real> middle = product<Real>(rotation_of_step<Real>(half_turn), r);
    const Vector3<Real> turn =
        gnc::scaled<Real>(rate_from_momentum<Real>(middle, momentum_lrf, inertia), step);
    r = product<Real>(rotation_of_step<Real>(turn), r);
  }
  return {r, rate_from_momentum<Real>(r, momentum_lrf, inertia)};
}

template <class Real>
Motion<Real> turned(const Motion<Real>& motion, const Matrix3<Real>& r_now_last) {
  return {product<Real>(r_now_last, motion.r_lrf_trf), product<Real>(r_now_last, motion.rate_lrf)};
}

template <class Real>
MotionModels<Real> motion_models(const Inertia<Real>& inertia) {
  MotionModels<Real> motion_models;
  for (int motion_model = kTumbleModel; motion_model < kMotionModels; ++motion_model)
    motion_models[motion_model] = inertia;
  for (int axis = 0; axis < 3; ++axis) {
    // S J S with S = diag(1, 1, sqrt(1/2)) (here for z): halves the moment and stays positive definite.
    Matrix3<Real> tensor_trf = inertia.tensor_trf;
    for (int other = 0; other < 3; ++other) {
      const Real product_of_inertia = constant<Real>(0.70710678118654752) * tensor_trf(axis, other);
      tensor_trf(axis, other) = tensor_trf(other, axis) = product_of_inertia;
    }
    tensor_trf(axis, axis) = constant<Real>(0.5) * inertia.tensor_trf(axis, axis);
    // If the result is too close to the inertia of a rod, the motion model keeps the target's own inertia.
    Inertia<Real>& motion_model = motion_models[kTumbleModel + 1 + axis];
    if (!make_inertia<Real>(tensor_trf, motion_model)) motion_model = inertia;
  }
  return motion_models;
}

std::array<std::int32_t, 3> rate_urad_s(const Vector3<Fixed>& rate) {
  constexpr std::int64_t kNumerator = 1'000'000 * (1'000'000'000 / 100'000'000);
  constexpr std::int64_t kDenominator = kNominalPeriod_ns / 100'000'000;
  std::array<std::int32_t, 3> result{};
  for (int i = 0; i < 3; ++i) {
    const std::int64_t doubled =
        divide(std::int64_t{rate[i].raw()} * kNumerator, kDenominator) >> (Fixed::kFractionBits - 1);
    result[static_cast<std::size_t>(i)] = static_cast<std::int32_t>((doubled + 1) >> 1);
  }
  return result;
}

#define TUMBLESIGHT_INSTANTIATE(Real)                                                       \
  template bool make_inertia(const Matrix3<Real>&, Inertia<Real>&);                         \
  template Matrix3<Real> rotation_from_vector(const Vector3<Real>&);                        \
  template Vector3<Real> small_rotation_vector(const Matrix3<Real>&);                       \
  template Vector3<Real> rotation_vector(const Matrix3<Real>&, Real);                       \
  template Motion<Real> propagate(const Motion<Real>&, const Inertia<Real>&, std::int64_t); \
  template Motion<Real> turned(const Motion<Real>&, const Matrix3<Real>&);                  \
  template MotionModels<Real> motion_models(const Inertia<Real>&)

TUMBLESIGHT_INSTANTIATE(Fixed);
#if TUMBLESIGHT_FLOAT32
TUMBLESIGHT_INSTANTIATE(float);
#endif

}  // namespace tumblesight::gnc
