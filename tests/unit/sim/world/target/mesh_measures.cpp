#include "tests/unit/sim/world/target/mesh_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "sim/world/target/primitives.hpp"

namespace tumblesight::sim {

namespace {

struct Corners {
  Eigen::Vector3f a, b, c;
};

Corners corners(const TriangleMesh& mesh, std::size_t i) {
  const auto& t = mesh.triangles[i];
  return {mesh.vertices_trf_m[t[0]], mesh.vertices_trf_m[t[1]], mesh.vertices_trf_m[t[2]]};
}

double area(const Corners& t) {
  return 0.5 * (t.b - t.a).cross(t.c - t.a).cast<double>().norm();
}

float squared_distance_to_edge(const Eigen::Vector3f& p, const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const Eigen::Vector3f edge = b - a;
  const float along = std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0F, 1.0F);
  return (p - a - along * edge).squaredNorm();
}

float squared_distance(const Eigen::Vector3f& p, const Corners& t) {
  const Eigen::Vector3f normal = (t.b - t.a).cross(t.c - t.a);
  const bool above = normal.dot((t.b - t.a).cross(p - t.a)) >= 0.0F &&
                     normal.dot((t.c - t.b).cross(p - t.b)) >= 0.0F &&
                     normal.dot((t.a - t.c).cross(p - t.c)) >= 0.0F;
  if (above) {
    const float height = normal.dot(p - t.a);
    return height * height / normal.squaredNorm();
  }
  return std::min({squared_distance_to_edge(p, t.a, t.b), squared_distance_to_edge(p, t.b, t.c),
                   squared_distance_to_edge(p, t.c, t.a)});
}

}  // namespace

double area_m2(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    sum += area(corners(mesh, i));
  }
  return sum;
}

double volume_m3(const TriangleMesh& mesh, const Eigen::Vector3d& inside) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Corners t = corners(mesh, i);
    const Eigen::Vector3d a = t.a.cast<double>() - inside;
    const Eigen::Vector3d b = t.b.cast<double>() - inside;
    const Eigen::Vector3d c = t.c.cast<double>() - inside;
    sum += std::abs(a.dot(b.cross(c))) / 6.0;
  }
  return sum;
}

Eigen::AlignedBox3f bounding_box(const TriangleMesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const auto& vertex : mesh.vertices_trf_m) {
    box.extend(vertex);
  }
  return box;
}

double closed_edge_share(const TriangleMesh& mesh) {
  using Place = std::array<long, 3>;
  const auto place = [&mesh](std::uint32_t vertex) {
    const Eigen::Vector3f& v = mesh.vertices_trf_m[vertex];
    return Place{std::lround(v.x() * 1e5F), std::lround(v.y() * 1e5F), std::lround(v.z() * 1e5F)};
  };
  std::map<std::pair<Place, Place>, int> uses;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Place from = place(t[k]);
      const Place to = place(t[(k + 1) % 3]);
      ++uses[std::minmax(from, to)];
    }
  }
  const auto closed =
      std::count_if(uses.begin(), uses.end(), [](const auto& use) { return use.second == 2; });
  return static_cast<double>(closed) / static_cast<double>(uses.size());
}

std::vector<float> crossings_z_m(const TriangleMesh& mesh, float x, float y) {
  const auto cross = [](const Eigen::Vector2f& u, const Eigen::Vector2f& v) {
    return u.x() * v.y() - u.y() * v.x();
  };
  const Eigen::Vector2f p(x, y);
  std::vector<float> heights;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Corners t = corners(mesh, i);
    const Eigen::Vector2f a = t.a.head<2>() - p;
    const Eigen::Vector2f b = t.b.head<2>() - p;
    const Eigen::Vector2f c = t.c.head<2>() - p;
    const float whole = cross(b - a, c - a);
    const float of_a = cross(b, c) / whole;
    const float of_b = cross(c, a) / whole;
    if (whole != 0.0F && of_a >= 0.0F && of_b >= 0.0F && of_a + of_b <= 1.0F) {
      heights.push_back(of_a * t.a.z() + of_b * t.b.z() + (1.0F - of_a - of_b) * t.c.z());
    }
  }
  std::sort(heights.begin(), heights.end());
  return heights;
}

float reach_m(const TriangleMesh& mesh, const Eigen::Vector3f& axis,
              const std::function<bool(const Eigen::Vector3f&)>& belongs) {
  float reach = -std::numeric_limits<float>::infinity();
  for (const Eigen::Vector3f& v : mesh.vertices_trf_m) {
    if (belongs(v)) {
      reach = std::max(reach, axis.dot(v));
    }
  }
  return reach;
}

bool is_sound(const TriangleMesh& mesh) {
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t corner : t) {
      if (corner >= mesh.vertices_trf_m.size() || !mesh.vertices_trf_m[corner].allFinite()) {
        return false;
      }
    }
    const Eigen::Vector3f& a = mesh.vertices_trf_m[t[0]];
    if ((mesh.vertices_trf_m[t[1]] - a).cross(mesh.vertices_trf_m[t[2]] - a).norm() <= 1e-8F) {
      return false;
    }
  }
  return true;
}

double moved_by_turn_m(const TriangleMesh& mesh, float angle_rad) {
  return mean_distance_m(surface_points(mesh, 400), placed(mesh, turned(angle_rad)));
}

std::vector<Eigen::Vector3f> surface_points(const TriangleMesh& mesh, int count) {
  const double spacing = area_m2(mesh) / count;
  std::vector<Eigen::Vector3f> points;
  double passed = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Corners t = corners(mesh, i);
    for (passed += area(t); passed > spacing * static_cast<double>(points.size());) {
      // The R2 low-discrepancy sequence, mapped to the triangle.
      const double n = static_cast<double>(points.size()) + 1.0;
      double u = std::fmod(n * 0.7548776662466927, 1.0);
      double v = std::fmod(n * 0.5698402909980532, 1.0);
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      points.push_back(t.a + static_cast<float>(u) * (t.b - t.a) + static_cast<float>(v) * (t.c - t.a));
    }
  }
  return points;
}

double mean_distance_m(const std::vector<Eigen::Vector3f>& points, const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const Eigen::Vector3f& p : points) {
    float nearest = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      nearest = std::min(nearest, squared_distance(p, corners(mesh, i)));
    }
    sum += std::sqrt(nearest);
  }
  return sum / static_cast<double>(points.size());
}

}  // namespace tumblesight::sim
