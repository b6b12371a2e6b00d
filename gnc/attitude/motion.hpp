// Motion: attitude and rate of a rotating target, and where they are one frame later. Time is counted in
// frames, so that a rate is the turn of one frame period, in radians.
#pragma once

#include <Eigen/Core>

namespace tumblesight::gnc {

struct Motion {
  Eigen::Matrix3f r_lrf_trf = Eigen::Matrix3f::Identity();
  Eigen::Vector3f rate_lrf = Eigen::Vector3f::Zero();  // radians a frame
};

// Inertia of the target in the TRF and its inverse; only ratios matter.
struct Inertia {
  Eigen::Matrix3f tensor_trf = Eigen::Matrix3f::Identity();
  Eigen::Matrix3f inverse_trf = Eigen::Matrix3f::Identity();
};
// False unless the tensor is finite, symmetric and positive definite; `inertia` is untouched then.
[[nodiscard]] bool make_inertia(const Eigen::Matrix3f& tensor_trf, Inertia& inertia);

// Longer rates are shortened to this before they are used: twice what the network is trained for.
inline constexpr float kLargestRate = 1.9F;

// exp([turn]x); for turns up to kLargestRate within 1e-6.
Eigen::Matrix3f rotation_by(const Eigen::Vector3f& turn);
// Its inverse for turns below 60 degrees, within 1e-5; zero for longer ones.
Eigen::Vector3f small_turn_of(const Eigen::Matrix3f& rotation);

// One frame later, at constant rate in the LRF (paper, sampling of the sequences).
Motion spin(const Motion& motion);
// One frame later, free of torque: angular momentum is constant in the LRF and the rate follows from the
// attitude (paper, tumbling test). Midpoint method in four steps; at 54 degrees a frame within about 0.5
// degrees.
Motion tumble(const Motion& motion, const Inertia& inertia);

}  // namespace tumblesight::gnc
