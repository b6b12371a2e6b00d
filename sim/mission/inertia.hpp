// The inertia of a target as users give it.
#pragma once

#include <Eigen/Core>
#include <string>

namespace tumblesight::sim {

// Elements of an inertia tensor about the centre of mass; products of inertia with their minus sign, as they
// stand in the tensor.
struct InertiaElements {
  double xx, yy, zz, xy, xz, yz;  // kg m^2
};

Eigen::Matrix3d tensor_of(const InertiaElements& elements);

// Empty if a rigid body can have this inertia and a model image can hold it; otherwise the limits.
std::string fault_of_inertia(const Eigen::Matrix3d& inertia_kg_m2);

// Empty if a body within this radius of the centre of mass can have the inertia: one that is not denser than
// iron. Otherwise what is wrong, with what may have been meant.
std::string fault_of_inertia_in_mesh(const Eigen::Matrix3d& inertia_kg_m2, double radius_m);

}  // namespace tumblesight::sim
