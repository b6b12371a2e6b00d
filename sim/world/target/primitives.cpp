#include "sim/world/target/primitives.hpp"

#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace tumblesight::sim {

namespace {

constexpr float kTwoPi = 6.28318530718F;

void require(bool holds, const char* what) {
  if (!holds) {
    throw std::invalid_argument(what);
  }
}

std::uint32_t index(std::size_t i) {
  return static_cast<std::uint32_t>(i);
}

// The shortest turn from z to an axis: Eigen's FromTwoVectors(), whose singular value decomposition takes
// seconds to compile.
Eigen::Quaternionf turn_from_z_to(const Eigen::Vector3f& axis) {
  const Eigen::Vector3f to = axis.normalized();
  constexpr float kOpposite = -1.0F + 1e-5F;
  if (to.z() < kOpposite) return {0.0F, -1.0F, 0.0F, 0.0F};  // half a turn about x
  const float s = std::sqrt((1.0F + to.z()) * 2.0F);
  const Eigen::Vector3f vector = Eigen::Vector3f::UnitZ().cross(to) * (1.0F / s);
  return {0.5F * s, vector.x(), vector.y(), vector.z()};
}

}  // namespace

void append(TriangleMesh& whole, const TriangleMesh& part) {
  const std::uint32_t offset = index(whole.vertices_trf_m.size());
  whole.vertices_trf_m.insert(whole.vertices_trf_m.end(), part.vertices_trf_m.begin(),
                              part.vertices_trf_m.end());
  for (const auto& t : part.triangles) {
    whole.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  if (whole.is_panel.empty() && part.is_panel.empty()) return;
  whole.is_panel.resize(whole.triangles.size() - part.triangles.size());
  whole.is_panel.insert(whole.is_panel.end(), part.is_panel.begin(), part.is_panel.end());
  whole.is_panel.resize(whole.triangles.size());
}

TriangleMesh as_panel(TriangleMesh part) {
  part.is_panel.assign(part.triangles.size(), 1);
  return part;
}

TriangleMesh placed(TriangleMesh part, const Eigen::Isometry3f& pose) {
  for (Eigen::Vector3f& vertex : part.vertices_trf_m) {
    vertex = pose * vertex;
  }
  return part;
}

TriangleMesh mirrored(TriangleMesh part, int axis) {
  for (Eigen::Vector3f& vertex : part.vertices_trf_m) {
    vertex[axis] = -vertex[axis];
  }
  return part;
}

TriangleMesh with_mirror_image(const TriangleMesh& part, int axis) {
  TriangleMesh both = part;
  append(both, mirrored(part, axis));
  return both;
}

TriangleMesh cap(const Loop& loop) {
  require(loop.size() >= 3, "cap: a loop needs at least three points");
  TriangleMesh mesh;
  mesh.vertices_trf_m = loop;
  for (std::size_t i = 2; i < loop.size(); ++i) {
    mesh.triangles.push_back({0, index(i - 1), index(i)});
  }
  return mesh;
}

TriangleMesh band(const Loop& from, const Loop& to) {
  require(from.size() >= 3 && from.size() == to.size(),
          "band: two loops of equally many points, at least three");
  const std::size_t n = from.size();
  TriangleMesh mesh;
  mesh.vertices_trf_m = from;
  mesh.vertices_trf_m.insert(mesh.vertices_trf_m.end(), to.begin(), to.end());
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    mesh.triangles.push_back({index(i), index(next), index(n + next)});
    mesh.triangles.push_back({index(i), index(n + next), index(n + i)});
  }
  return mesh;
}

TriangleMesh strip(const Loop& from, const Loop& to) {
  require(from.size() >= 2 && from.size() == to.size(),
          "strip: two chains of equally many points, at least two");
  TriangleMesh mesh;
  for (std::size_t i = 1; i < from.size(); ++i) {
    append(mesh, cap({from[i - 1], from[i], to[i], to[i - 1]}));
  }
  return mesh;
}

TriangleMesh loft(const Loop& from, const Loop& to) {
  TriangleMesh mesh = band(from, to);
  append(mesh, cap(from));
  append(mesh, cap(to));
  return mesh;
}

Loop loop_at(const Outline& outline, float z) {
  Loop loop;
  for (const Eigen::Vector2f& p : outline) {
    loop.emplace_back(p.x(), p.y(), z);
  }
  return loop;
}

Outline regular_polygon(int sides, float radius, float first_corner_rad) {
  require(sides >= 3, "regular polygon: at least three sides");
  require(radius > 0.0F, "regular polygon: the radius must be positive");
  Outline outline;
  for (int i = 0; i < sides; ++i) {
    const float angle = first_corner_rad + kTwoPi * static_cast<float>(i) / static_cast<float>(sides);
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return outline;
}

TriangleMesh box(const Eigen::Vector3f& size) {
  require(size.minCoeff() > 0.0F, "box: every edge must be positive");
  const float x = size.x() / 2.0F;
  const float y = size.y() / 2.0F;
  return prism({{-x, -y}, {x, -y}, {x, y}, {-x, y}}, -size.z() / 2.0F, size.z() / 2.0F);
}

TriangleMesh box_between(const Eigen::Vector3f& min, const Eigen::Vector3f& max) {
  return placed(box(max - min), Eigen::Isometry3f(Eigen::Translation3f((min + max) / 2.0F)));
}

TriangleMesh prism(const Outline& outline, float z_from, float z_to) {
  require(z_from != z_to, "prism: its two ends coincide");
  return loft(loop_at(outline, z_from), loop_at(outline, z_to));
}

TriangleMesh upright_prism(const Outline& profile_uz, float heading_rad, float v_from, float v_to) {
  // The prism is built with u along x, height along y and its length along z; the right-handed frame has v =
  // -z.
  Eigen::Matrix3f axes;
  axes.col(0) = Eigen::Vector3f(std::cos(heading_rad), std::sin(heading_rad), 0.0F);
  axes.col(1) = Eigen::Vector3f::UnitZ();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  Eigen::Isometry3f pose = Eigen::Isometry3f::Identity();
  pose.linear() = axes;
  return placed(prism(profile_uz, -v_from, -v_to), pose);
}

TriangleMesh frustum(int sides, float radius_from, float radius_to, float z_from, float z_to,
                     float first_corner_rad) {
  require(z_from != z_to, "frustum: its two ends coincide");
  return loft(loop_at(regular_polygon(sides, radius_from, first_corner_rad), z_from),
              loop_at(regular_polygon(sides, radius_to, first_corner_rad), z_to));
}

TriangleMesh revolve(const Outline& profile_rz, int sides) {
  require(profile_rz.size() >= 2, "revolve: a profile needs at least two points");
  const auto ring = [sides](const Eigen::Vector2f& p) {
    return loop_at(regular_polygon(sides, p.x(), 0.0F), p.y());
  };
  const auto fan = [](const Loop& loop, float tip_z) {
    TriangleMesh cone;
    cone.vertices_trf_m = loop;
    cone.vertices_trf_m.emplace_back(0.0F, 0.0F, tip_z);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      cone.triangles.push_back({index(i), index((i + 1) % loop.size()), index(loop.size())});
    }
    return cone;
  };
  TriangleMesh mesh;
  for (std::size_t i = 1; i < profile_rz.size(); ++i) {
    const Eigen::Vector2f& a = profile_rz[i - 1];
    const Eigen::Vector2f& b = profile_rz[i];
    require(a.x() > 0.0F || b.x() > 0.0F, "revolve: two neighbouring points of the profile lie on the axis");
    if (a.x() == 0.0F) {
      append(mesh, fan(ring(b), a.y()));
    } else if (b.x() == 0.0F) {
      append(mesh, fan(ring(a), b.y()));
    } else {
      append(mesh, band(ring(a), ring(b)));
    }
  }
  return mesh;
}

TriangleMesh tube(const Eigen::Vector3f& from, const Eigen::Vector3f& to, float radius_from, float radius_to,
                  int sides) {
  const Eigen::Vector3f axis = to - from;
  require(axis.norm() > 0.0F, "tube: its two ends coincide");
  return placed(frustum(sides, radius_from, radius_to, 0.0F, axis.norm()), frame_along(from, axis));
}

Eigen::Isometry3f frame_along(const Eigen::Vector3f& origin, const Eigen::Vector3f& axis) {
  Eigen::Isometry3f pose = Eigen::Isometry3f::Identity();
  pose.linear() = turn_from_z_to(axis).toRotationMatrix();
  pose.translation() = origin;
  return pose;
}

Eigen::Isometry3f frame_at(const Eigen::Vector3f& origin, const Eigen::Vector3f& x,
                           const Eigen::Vector3f& y) {
  Eigen::Isometry3f pose = Eigen::Isometry3f::Identity();
  const Eigen::Vector3f z = x.cross(y).normalized();
  pose.linear().col(0) = x.normalized();
  pose.linear().col(1) = z.cross(x.normalized());
  pose.linear().col(2) = z;
  pose.translation() = origin;
  return pose;
}

Eigen::Isometry3f turned(float angle_rad) {
  return Eigen::Isometry3f(Eigen::AngleAxisf(angle_rad, Eigen::Vector3f::UnitZ()));
}

}  // namespace tumblesight::sim
