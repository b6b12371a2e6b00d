#include "sim/surface/surface_fit.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <array>
#include <optional>

#include "sim/surface/mesh_distance.hpp"

namespace tumblesight::sim {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr int kRounds = 3;
constexpr double kDamping = 0.01;

// The shares of the three corners in a point of the triangle. None: the triangle has no area.
std::optional<Vector3d> shares(const Vector3d& point, const Vector3d& a, const Vector3d& b,
                               const Vector3d& c) {
  const Vector3d to_b = b - a, to_c = c - a, normal = to_b.cross(to_c);
  const double square = normal.squaredNorm();
  if (!(square > 0.0)) return std::nullopt;
  const double of_b = (point - a).cross(to_c).dot(normal) / square;
  const double of_c = to_b.cross(point - a).dot(normal) / square;
  return Vector3d(1.0 - of_b - of_c, of_b, of_c);
}

// The normal equations of the moves of all vertices; the three coordinates have the same matrix.
struct Equations {
  Eigen::SparseMatrix<double> information;
  Eigen::MatrixX3d gradient;
};

Equations equations_of(const TriangleMesh& mesh, const std::vector<Vector3f>& points_m, double reach_m) {
  const auto vertices = static_cast<int>(mesh.vertices_trf_m.size());
  Equations equations{Eigen::SparseMatrix<double>(vertices, vertices), Eigen::MatrixX3d::Zero(vertices, 3)};
  Triplets elements;
  const MeshDistance distance(mesh);
  double weight = 0.0;
  for (const Vector3f& point_m : points_m) {
    const ClosestPoint closest = distance.closest(point_m);
    if (!(static_cast<double>(closest.distance_m) < reach_m)) continue;
    const auto& corners = mesh.triangles[closest.triangle];
    const auto vertex = [&](std::size_t k) -> Vector3d {
      return mesh.vertices_trf_m[corners[k]].cast<double>();
    };
    const auto share = shares(closest.point_m.cast<double>(), vertex(0), vertex(1), vertex(2));
    if (!share) continue;
    const Vector3d off_m = (point_m - closest.point_m).cast<double>();
    for (int i = 0; i < 3; ++i) {
      const auto row = static_cast<int>(corners[static_cast<std::size_t>(i)]);
      equations.gradient.row(row) += (*share)[i] * off_m.transpose();
      weight += (*share)[i] * (*share)[i];
      for (int k = 0; k < 3; ++k)
        elements.emplace_back(row, static_cast<int>(corners[static_cast<std::size_t>(k)]),
                              (*share)[i] * (*share)[k]);
    }
  }
  for (int i = 0; i < vertices; ++i) elements.emplace_back(i, i, kDamping * weight / vertices + 1e-9);
  equations.information.setFromTriplets(elements.begin(), elements.end());
  return equations;
}

}  // namespace

TriangleMesh fitted(TriangleMesh mesh, const std::vector<Vector3f>& points_m, double reach_m) {
  if (mesh.triangles.empty()) return mesh;
  for (int round = 0; round < kRounds; ++round) {
    const Equations equations = equations_of(mesh, points_m, reach_m);
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(equations.information);
    const Eigen::MatrixX3d moves_m = factors.solve(equations.gradient);
    for (std::size_t i = 0; i < mesh.vertices_trf_m.size(); ++i)
      mesh.vertices_trf_m[i] += moves_m.row(static_cast<int>(i)).transpose().cast<float>();
  }
  return mesh;
}

}  // namespace tumblesight::sim
