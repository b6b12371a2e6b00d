#include "sim/surface/surface_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "gnc/rcnn/model_format.hpp"
#include "gnc/surface/surface_mesh.hpp"
#include "sim/surface/mesh_distance.hpp"
#include "sim/surface/mesh_simplification.hpp"
#include "sim/surface/outside_views.hpp"
#include "sim/surface/surface_fit.hpp"

namespace tumblesight::sim {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using gnc::SurfaceMesh;

// Errors that simplified() may make: the first one, doubled until the triangles fit into a section, then
// larger by kErrorStep as long as the surface stays near.
constexpr double kError_m = 5e-3;
constexpr double kError_radii = 1.0 / 500.0;
constexpr double kErrorStep = 1.1892;  // four double it
constexpr int kMostErrorSteps = 8;
// The mean distance from the true surface up to which triangles are saved. The pose depends on the mean: with
// NEAR, Magellan and stowed Aquarius it is as accurate as with the first error.
constexpr double kMeanDistance_radii = 1.0 / 5000.0;
constexpr double kReachPerError = 2.0;  // of points that count for the fit
constexpr double kWeldPerError = 0.2;
constexpr double kCoarseWeldPerError = 0.25;
constexpr double kCoarseFrom = 16.0;      // times the first error
constexpr double kPlaneCosine = -0.9994;  // of the directions away from an edge in its two faces
constexpr double kLargestError_mm = 65'535.0;
// A side that gets fewer of a triangle's hits is seen through slits at most.
constexpr double kLeastShareOfASide = 0.01;

struct Edge {
  std::array<std::uint32_t, 2> ends, opposite;
};

// Coordinates in units of the radius / SurfaceMesh::kRadius, each a whole number.
struct Surface {
  TriangleMesh mesh;
  std::vector<Edge> edges;
  std::vector<std::array<std::uint32_t, 3>> faces{};  // the triangles' sides that can be seen
  OuterSurface outer{};                               // in metres
};

TriangleMesh part_of(const TriangleMesh& mesh, const std::vector<std::uint8_t>& is_in) {
  TriangleMesh part;
  part.name = mesh.name;
  part.vertices_trf_m = mesh.vertices_trf_m;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (is_in[i] != 0) part.triangles.push_back(mesh.triangles[i]);
  }
  return part;
}

// A triangle that no ray meets but with seen ones on two of its edges is too narrow for the rays. Without it
// the surface would have a slit.
std::vector<std::uint8_t> with_narrow_ones(const TriangleMesh& mesh, std::vector<std::uint8_t> is_seen) {
  std::vector<int> seen_neighbours(mesh.triangles.size(), 0);
  for (const auto& [ends, triangles] : triangles_of_edges(mesh)) {
    const bool any =
        std::any_of(triangles.begin(), triangles.end(), [&](std::size_t i) { return is_seen[i] != 0; });
    for (const std::size_t triangle : triangles) seen_neighbours[triangle] += any ? 1 : 0;
  }
  for (std::size_t i = 0; i < is_seen.size(); ++i) {
    if (seen_neighbours[i] >= 2) is_seen[i] = 1;
  }
  return is_seen;
}

TriangleMesh in_units(TriangleMesh mesh, double radius_m) {
  for (Vector3f& vertex : mesh.vertices_trf_m) {
    for (float& coordinate : vertex) {
      const double units = std::round(static_cast<double>(coordinate) * SurfaceMesh::kRadius / radius_m);
      coordinate = static_cast<float>(std::clamp<double>(units, -SurfaceMesh::kRadius, SurfaceMesh::kRadius));
    }
  }
  return mesh;
}

TriangleMesh in_metres(TriangleMesh mesh, double radius_m) {
  for (Vector3f& vertex : mesh.vertices_trf_m) vertex *= static_cast<float>(radius_m / SurfaceMesh::kRadius);
  return mesh;
}

TriangleMesh without_flat_triangles(const TriangleMesh& mesh) {
  std::vector<std::uint8_t> has_area;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d first = mesh.vertices_trf_m[a].cast<double>();
    const Vector3d second = mesh.vertices_trf_m[b].cast<double>() - first;
    const Vector3d third = mesh.vertices_trf_m[c].cast<double>() - first;
    has_area.push_back(second.cross(third).isZero(0.0) ? 0 : 1);
  }
  return part_of(mesh, has_area);
}

// Unit vector from the edge to the corner, across the edge.
Vector3d away_from_edge(const TriangleMesh& mesh, const MeshEdge& ends, std::uint32_t corner) {
  const Vector3d from = mesh.vertices_trf_m[ends.first].cast<double>();
  const Vector3d along = (mesh.vertices_trf_m[ends.second].cast<double>() - from).normalized();
  const Vector3d to_corner = mesh.vertices_trf_m[corner].cast<double>() - from;
  return (to_corner - along.dot(to_corner) * along).normalized();
}

std::uint32_t corner_opposite(const std::array<std::uint32_t, 3>& triangle, const MeshEdge& ends) {
  for (const std::uint32_t corner : triangle) {
    if (corner != ends.first && corner != ends.second) return corner;
  }
  return ends.first;  // a triangle without area, of which a welded mesh has none
}

std::vector<Edge> silhouette_edges(const TriangleMesh& mesh) {
  std::vector<Edge> edges;
  for (const auto& [ends, triangles] : triangles_of_edges(mesh)) {
    std::vector<std::uint32_t> corners;
    std::vector<Vector3d> away;
    for (const std::size_t triangle : triangles) {
      corners.push_back(corner_opposite(mesh.triangles[triangle], ends));
      away.push_back(away_from_edge(mesh, ends, corners.back()));
    }
    Edge edge{{ends.first, ends.second}, {corners.front(), corners.front()}};
    double least_cosine = 2.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (std::size_t k = i + 1; k < corners.size(); ++k) {
        const double cosine = away[i].dot(away[k]);
        if (cosine >= least_cosine) continue;
        least_cosine = cosine;
        edge.opposite = {corners[i], corners[k]};
      }
    }
    if (least_cosine >= kPlaneCosine) edges.push_back(edge);
  }
  return edges;
}

// The surface to be simplified, and some of its points: enough for the fit, in a quarter of the time.
struct SeenSurface {
  TriangleMesh mesh;
  std::vector<Vector3f> points_m;
};
std::vector<Vector3f> one_in_four(const std::vector<Vector3f>& points_m) {
  std::vector<Vector3f> some;
  for (std::size_t i = 0; i < points_m.size(); i += 4) some.push_back(points_m[i]);
  return some;
}

Surface surface_within(const SeenSurface& seen, double error_m, double weld_m, double radius_m) {
  const TriangleMesh simple = fitted(simplified(oriented(welded(seen.mesh, weld_m)), error_m), seen.points_m,
                                     kReachPerError * error_m);
  // Whole units: what is closer than one is the same vertex.
  Surface surface{welded(without_flat_triangles(in_units(simple, radius_m)), 0.5), {}};
  surface.edges = silhouette_edges(surface.mesh);
  return surface;
}

double mean_distance_m(const std::vector<Vector3f>& points_m, const TriangleMesh& mesh) {
  const MeshDistance distance(mesh);
  double sum_m = 0.0;
  for (const Vector3f& point_m : points_m) sum_m += static_cast<double>(distance.distance_m(point_m));
  return sum_m / static_cast<double>(points_m.size());
}

// A triangle that no ray meets is narrower than the rays: it counts as seen from both sides.
std::vector<std::array<std::uint32_t, 3>> seen_faces(const TriangleMesh& mesh, const OuterSurface& outer) {
  std::vector<std::array<std::uint32_t, 3>> faces;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = mesh.triangles[i];
    const auto [front, back] = outer.hits[i];
    const double least = kLeastShareOfASide * (static_cast<double>(front) + static_cast<double>(back));
    if (static_cast<double>(front) >= least) faces.push_back({a, b, c});
    if (static_cast<double>(back) >= least) faces.push_back({a, c, b});
  }
  return faces;
}

bool fits(const Surface& surface) {
  return surface.mesh.vertices_trf_m.size() <= SurfaceMesh::kMaxVertices &&
         surface.mesh.triangles.size() <= SurfaceMesh::kMaxTriangles &&
         surface.edges.size() <= SurfaceMesh::kMaxEdges;
}

// With its sides, unless there are too many of them.
bool find_faces(Surface& surface, double radius_m) {
  surface.outer = outer_surface(in_metres(surface.mesh, radius_m));
  surface.faces = seen_faces(surface.mesh, surface.outer);
  return surface.faces.size() <= SurfaceMesh::kMaxTriangles;
}

double weld_m(double error_m, double first_m) {
  return error_m < kCoarseFrom * first_m ? kWeldPerError * first_m : kCoarseWeldPerError * error_m;
}

// The first error with which the triangles fit into a section, and the surface within it.
std::pair<double, Surface> first_that_fits(const SeenSurface& seen, double first_m, double radius_m) {
  for (double error_m = first_m;; error_m *= 2.0) {
    Surface surface = surface_within(seen, error_m, weld_m(error_m, first_m), radius_m);
    if (!fits(surface)) continue;
    if (surface.mesh.triangles.empty() || find_faces(surface, radius_m)) return {error_m, surface};
  }
}

// The fewest triangles whose mean distance is small, or else the first that fit into a section.
Surface simplified_to_fit(const SeenSurface& seen, double radius_m) {
  const double first_m = std::min(kError_m, kError_radii * seen.mesh.radius_m());
  auto [error_m, best] = first_that_fits(seen, first_m, radius_m);
  const auto is_near = [&](const Surface& surface) {
    return mean_distance_m(seen.points_m, in_metres(surface.mesh, radius_m)) <=
           kMeanDistance_radii * radius_m;
  };
  if (best.mesh.triangles.empty() || !is_near(best)) return best;
  Surface coarser = best;
  for (int step = 0; step < kMostErrorSteps; ++step) {
    error_m *= kErrorStep;
    Surface next = surface_within(seen, error_m, weld_m(error_m, first_m), radius_m);
    if (next.mesh.triangles.empty() || !is_near(next)) break;
    coarser = std::move(next);
  }
  return find_faces(coarser, radius_m) ? coarser : best;
}

// Rays miss what is small, which may be what has moved most: corners and the middles of edges are added.
std::vector<Vector3f> with_edges(std::vector<Vector3f> points_m, const TriangleMesh& mesh) {
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3f &first = mesh.vertices_trf_m[a], &second = mesh.vertices_trf_m[b],
                   &third = mesh.vertices_trf_m[c];
    points_m.insert(points_m.end(), {first, second, third});
    points_m.insert(points_m.end(),
                    {0.5F * (first + second), 0.5F * (second + third), 0.5F * (third + first)});
  }
  return points_m;
}

double largest_distance_m(const TriangleMesh& seen, const std::vector<Vector3f>& points_of_seen_m,
                          const TriangleMesh& simple, const std::vector<Vector3f>& points_of_simple_m) {
  return static_cast<double>(
      std::max(MeshDistance(simple).largest_distance_m(with_edges(points_of_seen_m, seen)),
               MeshDistance(seen).largest_distance_m(with_edges(points_of_simple_m, simple))));
}

class SectionWriter {
 public:
  void put(double value) {
    section_.resize(section_.size() + 2);
    gnc::model_format::put_u16(section_.data() + section_.size() - 2,
                               static_cast<std::uint16_t>(static_cast<std::int32_t>(value)));
  }
  const std::vector<std::uint8_t>& section() const { return section_; }

 private:
  std::vector<std::uint8_t> section_;
};

std::vector<std::uint8_t> section_of(const Surface& surface, double error_m) {
  SectionWriter writer;
  const TriangleMesh& mesh = surface.mesh;
  writer.put(static_cast<double>(mesh.vertices_trf_m.size()));
  writer.put(static_cast<double>(surface.faces.size()));
  writer.put(static_cast<double>(surface.edges.size()));
  writer.put(std::min(std::ceil(1e3 * error_m), kLargestError_mm));
  for (const Vector3f& vertex : mesh.vertices_trf_m) {
    for (const float units : vertex) writer.put(static_cast<double>(units));
  }
  for (const auto& face : surface.faces) {
    for (const std::uint32_t corner : face) writer.put(corner);
  }
  for (const Edge& edge : surface.edges) {
    for (const std::uint32_t end : edge.ends) writer.put(end);
    for (const std::uint32_t corner : edge.opposite) writer.put(corner);
  }
  return writer.section();
}

}  // namespace

std::vector<std::uint8_t> surface_mesh_section(const TriangleMesh& mesh, double radius_m) {
  if (!(radius_m > 0.0)) throw std::invalid_argument("the radius of " + mesh.name + " is not positive");
  const auto refuse = [&mesh] { throw std::invalid_argument(mesh.name + " has no surface"); };
  const double weld_m = kWeldPerError * std::min(kError_m, kError_radii * mesh.radius_m());
  if (!(weld_m > 0.0)) refuse();
  const TriangleMesh whole = welded(mesh, weld_m);
  if (whole.triangles.empty()) refuse();
  const OuterSurface outer = outer_surface(whole);
  const SeenSurface seen{part_of(whole, with_narrow_ones(whole, outer.is_seen)),
                         one_in_four(outer.points_trf_m)};
  if (seen.mesh.triangles.empty() || seen.points_m.empty()) refuse();
  const Surface surface = simplified_to_fit(seen, radius_m);
  if (surface.mesh.triangles.empty()) refuse();
  const TriangleMesh simple = in_metres(surface.mesh, radius_m);
  return section_of(surface,
                    largest_distance_m(seen.mesh, outer.points_trf_m, simple, surface.outer.points_trf_m));
}

}  // namespace tumblesight::sim
