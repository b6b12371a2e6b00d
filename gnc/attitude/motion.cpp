#include "gnc/attitude/motion.hpp"

#include <cmath>

#include "gnc/attitude/rotation.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kSteps = 4;

Eigen::Vector3f bounded(const Eigen::Vector3f& rate) {
  const float square = (rate.x() * rate.x() + rate.y() * rate.y()) + rate.z() * rate.z();
  const float scale = square > kLargestRate * kLargestRate ? kLargestRate / std::sqrt(square) : 1.0F;
  return rate * scale;
}

// The rate of a body of this inertia whose angular momentum is `momentum_lrf`.
Eigen::Vector3f rate_of(const Eigen::Matrix3f& r_lrf_trf, const Eigen::Vector3f& momentum_lrf,
                        const Inertia& inertia) {
  return product(r_lrf_trf, product(inertia.inverse_trf, transpose_product(r_lrf_trf, momentum_lrf)));
}

}  // namespace

bool make_inertia(const Eigen::Matrix3f& tensor_trf, Inertia& inertia) {
  const Eigen::Matrix3f& j = tensor_trf;
  const float trace = (j(0, 0) + j(1, 1)) + j(2, 2);
  const bool symmetric = j(0, 1) == j(1, 0) && j(0, 2) == j(2, 0) && j(1, 2) == j(2, 1);
  if (!std::isfinite(trace) || !(trace > 0.0F) || !symmetric) return false;
  // Adjugate over determinant; the leading minors decide on definiteness.
  Eigen::Matrix3f adjugate;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      adjugate(k, i) = j(i1, k1) * j(i2, k2) - j(i1, k2) * j(i2, k1);
    }
  }
  const float determinant = (j(0, 0) * adjugate(0, 0) + j(0, 1) * adjugate(1, 0)) + j(0, 2) * adjugate(2, 0);
  const float size = trace / 3.0F;
  const float smallest_determinant =
      1e-4F * size * size * size;  // that of a rod a hundred times as long as thick
  if (!(j(0, 0) > 0.0F) || !(adjugate(2, 2) > 0.0F) || !(determinant > smallest_determinant)) return false;
  inertia.tensor_trf = j;
  inertia.inverse_trf = adjugate / determinant;
  return true;
}

Eigen::Matrix3f rotation_by(const Eigen::Vector3f& turn) {
  const Eigen::Vector3f v = bounded(turn);
  const float s = (v.x() * v.x() + v.y() * v.y()) + v.z() * v.z();
  // sin(a) / a and (1 - cos(a)) / a^2 as Taylor series in a^2.
  const float a =
      1.0F -
      s / 6.0F *
          (1.0F -
           s / 20.0F * (1.0F - s / 42.0F * (1.0F - s / 72.0F * (1.0F - s / 110.0F * (1.0F - s / 156.0F)))));
  const float b =
      0.5F -
      s / 24.0F *
          (1.0F -
           s / 30.0F * (1.0F - s / 56.0F * (1.0F - s / 90.0F * (1.0F - s / 132.0F * (1.0F - s / 182.0F)))));
  const float c = 1.0F - b * s;
  Eigen::Matrix3f r;
  r << c + b * v.x() * v.x(), b * v.x() * v.y() - a * v.z(), b * v.x() * v.z() + a * v.y(),
      b * v.x() * v.y() + a * v.z(), c + b * v.y() * v.y(), b * v.y() * v.z() - a * v.x(),
      b * v.x() * v.z() - a * v.y(), b * v.y() * v.z() + a * v.x(), c + b * v.z() * v.z();
  return r;
}

Eigen::Vector3f small_turn_of(const Eigen::Matrix3f& r) {
  const float trace = (r(0, 0) + r(1, 1)) + r(2, 2);
  const float y = 0.5F * (3.0F - trace);  // 1 - cos(angle)
  // angle / sin(angle) as a series in y, of which the ratio of neighbours is n / (2n + 1).
  const float f =
      1.0F +
      y * (1.0F / 3.0F) *
          (1.0F +
           y * (2.0F / 5.0F) *
               (1.0F + y * (3.0F / 7.0F) *
                           (1.0F + y * (4.0F / 9.0F) *
                                       (1.0F + y * (5.0F / 11.0F) *
                                                   (1.0F + y * (6.0F / 13.0F) *
                                                               (1.0F + y * (7.0F / 15.0F) *
                                                                           (1.0F + y * (8.0F / 17.0F))))))));
  const float half = y < 0.5F ? 0.5F * f : 0.0F;  // 60 degrees
  return {half * (r(2, 1) - r(1, 2)), half * (r(0, 2) - r(2, 0)), half * (r(1, 0) - r(0, 1))};
}

Motion tumble(const Motion& motion, const Inertia& inertia) {
  const Eigen::Vector3f rate = bounded(motion.rate_lrf);
  const Eigen::Vector3f momentum_lrf =
      product(motion.r_lrf_trf, product(inertia.tensor_trf, transpose_product(motion.r_lrf_trf, rate)));
  Eigen::Matrix3f r = motion.r_lrf_trf;
  for (int i = 0; i < kSteps; ++i) {
    constexpr float kStep = 1.0F / static_cast<float>(kSteps);
    const Eigen::Matrix3f middle =
        product(rotation_by(rate_of(r, momentum_lrf, inertia) * (0.5F * kStep)), r);
    r = product(rotation_by(rate_of(middle, momentum_lrf, inertia) * kStep), r);
  }
  return {r, rate_of(r, momentum_lrf, inertia)};
}

MotionLaws motion_laws(const Inertia& inertia) {
  MotionLaws laws;
  for (int law = kTumbleLaw; law < kLaws; ++law) laws[law] = inertia;
  for (int axis = 0; axis < 3; ++axis) {
    // S J S with S = diag(1, 1, sqrt(1/2)): positive definite as J is.
    constexpr float kSqrtHalf = 0.70710678F;
    Eigen::Matrix3f tensor_trf = inertia.tensor_trf;
    for (int other = 0; other < 3; ++other) {
      const float product_of_inertia = kSqrtHalf * tensor_trf(axis, other);
      tensor_trf(axis, other) = tensor_trf(other, axis) = product_of_inertia;
    }
    tensor_trf(axis, axis) = 0.5F * inertia.tensor_trf(axis, axis);
    // An inertia that is next to a rod's already stays as it is.
    if (!make_inertia(tensor_trf, laws[kTumbleLaw + 1 + axis])) laws[kTumbleLaw + 1 + axis] = inertia;
  }
  return laws;
}

}  // namespace tumblesight::gnc
