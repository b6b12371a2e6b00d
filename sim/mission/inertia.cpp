#include "sim/mission/inertia.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "gnc/attitude/motion.hpp"

namespace tumblesight::sim {
namespace {

// Covers bodies from the size of a hand to that of a space station.
constexpr double kSmallestMoment_kg_m2 = 1e-6;
constexpr double kLargestMoment_kg_m2 = 1e12;
constexpr double kIron_kg_m3 = 7870.0;

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

std::string fault_of_inertia_in_mesh(const Eigen::Matrix3d& inertia_kg_m2, double radius_m) {
  const double mass_kg = kIron_kg_m3 * 4.0 / 3.0 * M_PI * radius_m * radius_m * radius_m;
  const double of_ball_kg_m2 = 0.4 * mass_kg * radius_m * radius_m;
  const double largest_kg_m2 = inertia_kg_m2.diagonal().maxCoeff();
  if (largest_kg_m2 <= of_ball_kg_m2) return {};
  return fmt::format(
      "the inertia of {:.3g} kg m2 is larger than that of a ball of iron with the mesh's radius of {:.3g} m, "
      "{:.3g} kg m2; give it in kg m2 (one in kg mm2 is a million times as large), or correct the unit "
      "of the mesh",
      largest_kg_m2, radius_m, of_ball_kg_m2);
}

}  // namespace tumblesight::sim
