#include "sim/surface/mesh_simplification.hpp"

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#ifdef TUMBLESIGHT_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

namespace tumblesight::sim {
namespace {

using Eigen::Vector3f;
using Triangle = std::array<std::uint32_t, 3>;

// Finds vertices by their place: boxes as large as the distance.
class VertexFinder {
 public:
  explicit VertexFinder(double distance_m) : distance_m_(distance_m) {}

  // The earliest vertex within the distance, else `vertices` grows by this one.
  std::uint32_t find_or_add(const Vector3f& vertex_m, std::vector<Vector3f>& vertices) {
    const std::array<std::int64_t, 3> box = box_of(vertex_m);
    std::uint32_t found = kNone;
    for (std::int64_t i = 0; i < 27; ++i) {
      const auto near = boxes_.find(key({box[0] + i % 3 - 1, box[1] + i / 3 % 3 - 1, box[2] + i / 9 - 1}));
      if (near == boxes_.end()) continue;
      for (const std::uint32_t other : near->second) {
        if (other < found && (vertices[other] - vertex_m).cast<double>().norm() <= distance_m_) found = other;
      }
    }
    if (found != kNone) return found;
    const auto added = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back(vertex_m);
    boxes_[key(box)].push_back(added);
    return added;
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::array<std::int64_t, 3> box_of(const Vector3f& vertex_m) const {
    std::array<std::int64_t, 3> box{};
    for (std::size_t k = 0; k < 3; ++k) box[k] = std::llround(vertex_m[static_cast<int>(k)] / distance_m_);
    return box;
  }
  // Boxes of the same key are merely looked through together.
  static std::uint64_t key(const std::array<std::int64_t, 3>& box) {
    constexpr std::uint64_t kMask = (1U << 21) - 1;
    return (static_cast<std::uint64_t>(box[0]) & kMask) << 42 |
           (static_cast<std::uint64_t>(box[1]) & kMask) << 21 | (static_cast<std::uint64_t>(box[2]) & kMask);
  }

  double distance_m_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> boxes_;
};

Triangle sorted(Triangle triangle) {
  std::sort(triangle.begin(), triangle.end());
  return triangle;
}

bool runs_along(const Triangle& triangle, std::uint32_t from, std::uint32_t to) {
  return (triangle[0] == from && triangle[1] == to) || (triangle[1] == from && triangle[2] == to) ||
         (triangle[2] == from && triangle[0] == to);
}

}  // namespace

std::map<MeshEdge, std::vector<std::size_t>> triangles_of_edges(const TriangleMesh& mesh) {
  std::map<MeshEdge, std::vector<std::size_t>> edges;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      edges[std::minmax(mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3])].push_back(i);
  }
  return edges;
}

TriangleMesh welded(const TriangleMesh& mesh, double distance_m) {
  TriangleMesh result;
  result.name = mesh.name;
  VertexFinder finder(distance_m);
  constexpr std::uint32_t kNotYet = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> renamed(mesh.vertices_trf_m.size(), kNotYet);
  std::set<Triangle> seen;
  for (const Triangle& triangle : mesh.triangles) {
    Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& to = renamed[triangle[k]];
      if (to == kNotYet) to = finder.find_or_add(mesh.vertices_trf_m[triangle[k]], result.vertices_trf_m);
      corners[k] = to;
    }
    const bool whole = corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0];
    if (whole && seen.insert(sorted(corners)).second) result.triangles.push_back(corners);
  }
  return result;
}

TriangleMesh oriented(TriangleMesh mesh) {
  const auto edges = triangles_of_edges(mesh);
  std::vector<std::uint8_t> is_done(mesh.triangles.size(), 0);
  std::vector<std::size_t> next;
  const auto visit_neighbours = [&](std::size_t index) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[index][k], to = mesh.triangles[index][(k + 1) % 3];
      const std::vector<std::size_t>& sharing = edges.at(std::minmax(from, to));
      if (sharing.size() != 2) continue;
      const std::size_t other = sharing[0] == index ? sharing[1] : sharing[0];
      if (is_done[other] != 0) continue;
      if (runs_along(mesh.triangles[other], from, to))
        std::swap(mesh.triangles[other][1], mesh.triangles[other][2]);
      is_done[other] = 1;
      next.push_back(other);
    }
  };
  for (std::size_t first = 0; first < mesh.triangles.size(); ++first) {
    if (is_done[first] != 0) continue;
    is_done[first] = 1;
    next.push_back(first);
    while (!next.empty()) {
      const std::size_t index = next.back();
      next.pop_back();
      visit_neighbours(index);
    }
  }
  return mesh;
}

#ifdef TUMBLESIGHT_HAS_MESHOPTIMIZER

TriangleMesh simplified(const TriangleMesh& mesh, double error_m) {
  TriangleMesh result;
  result.name = mesh.name;
  if (mesh.triangles.empty()) return result;
  std::vector<std::uint32_t> corners, left(3 * mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles)
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  const float* positions = mesh.vertices_trf_m.front().data();
  const std::size_t vertices = mesh.vertices_trf_m.size();
  const double extent_m = static_cast<double>(meshopt_simplifyScale(positions, vertices, sizeof(Vector3f)));
  left.resize(meshopt_simplify(left.data(), corners.data(), corners.size(), positions, vertices,
                               sizeof(Vector3f), 0, static_cast<float>(error_m / extent_m), 0, nullptr));
  result.vertices_trf_m = mesh.vertices_trf_m;
  for (std::size_t i = 0; i < left.size(); i += 3)
    result.triangles.push_back({left[i], left[i + 1], left[i + 2]});
  return result;
}

#else

TriangleMesh simplified(const TriangleMesh&, double) {
  throw std::runtime_error(
      "this build has no meshoptimizer and simplifies no meshes; install libmeshoptimizer-dev, configure and "
      "build again");
}

#endif

}  // namespace tumblesight::sim
