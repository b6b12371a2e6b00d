// A spacecraft that has no symmetry, and what can be wrong with its mesh.
#pragma once

#include "sim/world/target/primitives.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

inline TriangleMesh box_at(float x, float y, float z, const Eigen::Vector3f& size) {
  const Eigen::Vector3f half = 0.5F * size, centre(x, y, z);
  return box_between(centre - half, centre + half);
}

// Body, one wing, dish and instruments, all of them different; its surface's centre is near the origin.
inline TriangleMesh sound_mesh() {
  TriangleMesh mesh;
  append(mesh, box_at(0.0F, 0.0F, 0.0F, {1.2F, 1.0F, 1.6F}));
  append(mesh, box_at(1.3F, 0.0F, 0.2F, {1.6F, 0.03F, 1.0F}));
  append(mesh, box_at(-0.8F, 0.1F, 0.4F, {0.5F, 0.4F, 0.3F}));
  append(mesh, frustum(24, 0.2F, 0.7F, 0.8F, 1.1F));
  append(mesh, box_at(-0.2F, 0.7F, -0.5F, {0.4F, 0.5F, 0.2F}));
  append(mesh, box_at(-1.1F, -0.1F, -0.3F, {1.2F, 0.2F, 0.6F}));
  mesh.name = "sound.stl";
  return mesh;
}

// Four shells: the body, a cube of 12 triangles about the origin; two panels; an antenna.
inline TriangleMesh cubesat() {
  TriangleMesh mesh = box({1.0F, 1.0F, 1.0F});
  append(mesh, box_at(0.0F, 1.1F, 0.0F, {0.8F, 1.0F, 0.02F}));
  append(mesh, box_at(0.0F, -1.1F, 0.1F, {0.8F, 1.0F, 0.02F}));
  append(mesh, placed(frustum(24, 0.2F, 0.05F, 0.55F, 0.95F),
                      Eigen::Isometry3f(Eigen::Translation3f(0.2F, 0.1F, 0.0F))));
  mesh.name = "cubesat.stl";
  return mesh;
}

inline TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3f& by) {
  for (Eigen::Vector3f& vertex : mesh.vertices_trf_m) vertex += by;
  return mesh;
}

inline TriangleMesh times(TriangleMesh mesh, float factor) {
  for (Eigen::Vector3f& vertex : mesh.vertices_trf_m) vertex *= factor;
  return mesh;
}

inline TriangleMesh with(TriangleMesh mesh, const TriangleMesh& part) {
  append(mesh, part);
  return mesh;
}

inline TriangleMesh doubled(const TriangleMesh& mesh) {
  TriangleMesh twice = mesh;
  for (auto [a, b, c] : mesh.triangles) twice.triangles.push_back({a, c, b});
  return twice;
}

}  // namespace tumblesight::sim
