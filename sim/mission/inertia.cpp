#include "sim/mission/inertia.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "gnc/attitude/motion.hpp"

namespace tumblesight::sim {
namespace {

// Covers bodies from the size of a hand to that of a space station.
constexpr double kSmallestMoment_kg_m2 = 1e-6;
constexpr double kLargestMoment_kg_m2 = 1e12;

// No principal moment of a body exceeds the sum of the other two. None may be smaller than a model image can
// hold.
bool is_possible(const Eigen::Matrix3d& inertia) {
  if (!inertia.allFinite() || inertia.cwiseAbs().maxCoeff() > kLargestMoment_kg_m2) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d moments = solver.eigenvalues();  // ascending
  const double smallest = std::max(kSmallestMoment_kg_m2, gnc::kSmallestMoment * moments.mean());
  return moments[0] >= smallest && moments[2] <= moments[0] + moments[1];
}

}  // namespace

Eigen::Matrix3d tensor_of(const InertiaElements& i) {
  Eigen::Matrix3d tensor;
  tensor << i.xx, i.xy, i.xz, i.xy, i.yy, i.yz, i.xz, i.yz, i.zz;
  return tensor;
}

std::string fault_of_inertia(const Eigen::Matrix3d& inertia_kg_m2) {
  if (is_possible(inertia_kg_m2)) return {};
  return fmt::format(
      "no rigid body has this inertia; its principal moments must be {:g} to {:g} kg m2, none larger than "
      "the sum of the other two and none below {:g} of their mean",
      kSmallestMoment_kg_m2, kLargestMoment_kg_m2, gnc::kSmallestMoment);
}

}  // namespace tumblesight::sim
