#include "sim/inspection/mesh_edges.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace tumblesight::sim {
namespace {

struct Use {
  std::uint32_t low, high;
  bool forward;  // the triangle runs from the lower corner to the higher one
};

std::vector<Use> sorted_uses(const TriangleMesh& mesh) {
  std::vector<Use> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t from = t[i], to = t[(i + 1) % 3];
      uses.push_back({std::min(from, to), std::max(from, to), from < to});
    }
  }
  std::sort(uses.begin(), uses.end(),
            [](const Use& a, const Use& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  return uses;
}

}  // namespace

MeshEdges edges_of(const TriangleMesh& mesh) {
  const std::vector<Use> uses = sorted_uses(mesh);
  MeshEdges edges;
  for (std::size_t first = 0; first < uses.size();) {
    std::size_t end = first;
    while (end < uses.size() && uses[end].low == uses[first].low && uses[end].high == uses[first].high) ++end;
    ++edges.edges;
    if (end - first == 1) ++edges.open;
    if (end - first > 2) ++edges.crowded;
    if (end - first == 2 && uses[first].forward == uses[first + 1].forward) ++edges.turned;
    first = end;
  }
  return edges;
}

std::vector<std::uint8_t> repeated_triangles(const TriangleMesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> corners = mesh.triangles;
  for (auto& t : corners) std::sort(t.begin(), t.end());
  std::vector<std::size_t> order(corners.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return corners[a] < corners[b]; });
  std::vector<std::uint8_t> repeated(corners.size(), 0);
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (corners[order[i]] == corners[order[i - 1]]) repeated[order[i]] = 1;
  }
  return repeated;
}

}  // namespace tumblesight::sim
