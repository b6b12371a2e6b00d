// EmbreeScene: a mesh as Embree holds it, for queries in one thread or several.
#pragma once

#include <embree3/rtcore.h>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

class EmbreeScene {
 public:
  // Copies the triangles; their numbers stay. Throws std::runtime_error if Embree refuses the mesh.
  explicit EmbreeScene(const TriangleMesh& mesh);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene get() const { return scene_; }

 private:
  void build(const TriangleMesh& mesh);
  void release();

  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

}  // namespace tumblesight::sim
