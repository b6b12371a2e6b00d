// SurfaceMesh: the outer surface of the target as triangles, which the ground makes from its mesh
// (sim/surface/surface_mesh.hpp). Registration renders it. It is read where it lies, in a section of its
// own.
//
// All numbers are little-endian.
//   offset  size  field
//        0     2  number of vertices V, 0 to 3072; 0: the shape is not known
//        2     2  number of triangles T, 0 to 6144
//        4     2  number of edges E, 0 to 8192
//        6     2  largest distance from the mesh that it was made from [mm]
//        8   6 V  vertices: x, y, z in the TRF, signed 16 bits, in units of the target's radius / 32767
//        -   6 T  triangles: three numbers of vertices, counterclockwise as seen from the side that reflects;
//                 what reflects on both sides is there twice
//        -   8 E  edges that can lie on a silhouette: the two ends, then the corners opposite to it of the
//                 two triangles that share it. The same corner twice: only one triangle has it
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tumblesight::gnc {

class SurfaceMesh {
 public:
  static constexpr int kMaxVertices = 3072;
  static constexpr int kMaxTriangles = 6144;
  static constexpr int kMaxEdges = 8192;
  static constexpr int kRadius = 32767;  // of the target, in the unit of the vertices
  static constexpr std::size_t kHeaderBytes = 8;
  static constexpr std::size_t kMaxBytes = kHeaderBytes + std::size_t{6} * kMaxVertices +
                                           std::size_t{6} * kMaxTriangles + std::size_t{8} * kMaxEdges;

  using Vertex = std::array<std::int32_t, 3>;
  using Triangle = std::array<std::int32_t, 3>;
  struct Edge {
    std::int32_t first, second;            // its ends
    std::array<std::int32_t, 2> opposite;  // corners of its triangles
  };

  SurfaceMesh() = default;  // without triangles
  // `section` stays in place. Requires is_sound(section, size).
  explicit SurfaceMesh(const std::uint8_t* section)
      : vertices_(u16(section)),
        triangles_(u16(section + 2)),
        edges_(u16(section + 4)),
        error_mm_(u16(section + 6)),
        vertex_data_(section + kHeaderBytes),
        triangle_data_(vertex_data_ + std::size_t{6} * vertices_),
        edge_data_(triangle_data_ + std::size_t{6} * triangles_) {}

  // Whether the counts are within their limits and fit into `size_bytes`, and every vertex that is named
  // exists.
  static bool is_sound(const std::uint8_t* section, std::size_t size_bytes);

  bool is_known() const { return triangles_ != 0; }
  int vertices() const { return vertices_; }
  int triangles() const { return triangles_; }
  int edges() const { return edges_; }
  int error_mm() const { return error_mm_; }
  // Whether vertices of all these numbers exist.
  template <class... Numbers>
  bool has(Numbers... numbers) const {
    const std::int32_t last = vertices_ - 1;
    return ((last - numbers) | ...) >= 0;  // no difference has its sign bit set
  }

  Vertex vertex(int index) const {
    const std::uint8_t* at = vertex_data_ + std::size_t{6} * static_cast<std::size_t>(index);
    return {i16(at), i16(at + 2), i16(at + 4)};
  }
  Triangle triangle(int index) const {
    const std::uint8_t* at = triangle_data_ + std::size_t{6} * static_cast<std::size_t>(index);
    return {u16(at), u16(at + 2), u16(at + 4)};
  }
  Edge edge(int index) const {
    const std::uint8_t* at = edge_data_ + std::size_t{8} * static_cast<std::size_t>(index);
    return {u16(at), u16(at + 2), {u16(at + 4), u16(at + 6)}};
  }

 private:
  static std::int32_t u16(const std::uint8_t* at) {
    std::int32_t high = at[1];
#if defined(__sparc__)
    // Otherwise the compiler loads both bytes together and exchanges them, in twice as many instructions.
    asm("" : "+r"(high));
#endif
    return at[0] | (high << 8);
  }
  static std::int32_t i16(const std::uint8_t* at) {
    return static_cast<std::int16_t>(u16(at));
  }

  std::int32_t vertices_ = 0, triangles_ = 0, edges_ = 0, error_mm_ = 0;
  const std::uint8_t* vertex_data_ = nullptr;
  const std::uint8_t* triangle_data_ = nullptr;
  const std::uint8_t* edge_data_ = nullptr;
};

}  // namespace tumblesight::gnc
