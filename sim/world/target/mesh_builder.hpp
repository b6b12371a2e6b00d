// MeshBuilder: what a reader of a mesh file has found so far, in the TRF and in metres.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>

#include "sim/world/target/mesh_file.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// Whether the name of a material says that its parts are solar panels.
bool names_a_panel(std::string material);

class MeshBuilder {
 public:
  // `unit`: by what the file is counted in messages, "line" or "triangle". Both must outlive the builder.
  MeshBuilder(const MeshFileOptions& options, const char* unit);

  // A place in the axes and the unit of the file; returns its number. One that is not finite is counted, and
  // `number` says where the first is.
  std::uint32_t add_vertex(const Eigen::Vector3d& place, std::size_t number);
  // Throws std::runtime_error beyond kMaxTriangles.
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, bool is_panel = false);

  void add_note(const std::string& note) { mesh_.notes.push_back(note); }
  void add_loss(const std::string& loss) { mesh_.losses.push_back(loss); }
  std::size_t triangles() const { return mesh_.triangles.size(); }

  // The builder is empty afterwards. Throws std::runtime_error if a vertex is not finite.
  TriangleMesh finish();

 private:
  Eigen::Matrix3d to_trf_m_;
  Eigen::Vector3d origin_trf_m_;
  const char* unit_;
  TriangleMesh mesh_;
  bool any_panel_ = false;
  std::size_t not_finite_ = 0;
  std::size_t first_number_ = 0;
  Eigen::Vector3d first_place_ = Eigen::Vector3d::Zero();
};

// They throw std::runtime_error that says how many there are, what the limit is and what to do.
void check_triangle_count(std::size_t triangles);
void check_vertex_count(std::size_t vertices);

}  // namespace tumblesight::sim
