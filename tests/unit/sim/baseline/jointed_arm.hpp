// A target without any symmetry, of few triangles: three bars of different size on a box.
#pragma once

#include "sim/world/target/primitives.hpp"

namespace tumblesight::sim {

inline TriangleMesh jointed_arm() {
  const auto bar = [](const Eigen::Vector3f& size, const Eigen::Vector3f& centre) {
    return placed(box(size), Eigen::Isometry3f(Eigen::Translation3f(centre)));
  };
  TriangleMesh mesh = box({1.2F, 0.9F, 1.0F});
  mesh.name = "jointed arm";
  append(mesh, bar({2.0F, 0.3F, 0.5F}, {1.4F, 0.3F, 0.1F}));
  append(mesh, bar({0.4F, 1.5F, 0.3F}, {-0.3F, -1.1F, 0.4F}));
  append(mesh, bar({0.2F, 0.8F, 1.3F}, {0.4F, 0.0F, 1.1F}));
  return mesh;
}

}  // namespace tumblesight::sim
