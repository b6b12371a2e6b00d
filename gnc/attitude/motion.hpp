// Motion: attitude and rate of a rotating target, and where they are one frame later, by which law. Time is
// counted in frames, so that a rate is the turn of one frame period, in radians.
#pragma once

#include <Eigen/Core>
#include <array>

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

// One frame later, free of torque: angular momentum is constant in the LRF and the rate follows from the
// attitude (paper, tumbling test). Of a sphere's inertia the rate is constant in the LRF (paper, sampling of
// the sequences). Midpoint method in four steps; at 54 degrees a frame within about 0.5 degrees.
Motion tumble(const Motion& motion, const Inertia& inertia);

// The laws of motion that a target is thought to follow: tumbling with
//   0     a sphere's inertia: it spins at a rate constant in the LRF
//   1     its own inertia
//   2..4  its own with the moment about the TRF's x, y or z axis halved, for an inertia known to a factor of
//         two only: fuel is spent, an appendage broke off or never unfolded
inline constexpr int kLaws = 5;
inline constexpr int kSpinLaw = 0;
inline constexpr int kTumbleLaw = 1;
using MotionLaws = std::array<Inertia, kLaws>;
MotionLaws motion_laws(const Inertia& inertia);

}  // namespace tumblesight::gnc
