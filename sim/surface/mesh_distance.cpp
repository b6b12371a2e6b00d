#include "sim/surface/mesh_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "sim/world/sensor/embree_scene.hpp"

namespace tumblesight::sim {
namespace {

using Eigen::Vector3f;

Vector3f closest_on_segment(const Vector3f& point, const Vector3f& from, const Vector3f& to) {
  const Vector3f along = to - from;
  const float square = along.squaredNorm();
  if (!(square > 0.0F)) return from;
  return from + std::clamp(along.dot(point - from) / square, 0.0F, 1.0F) * along;
}

struct Query {
  const TriangleMesh* mesh;
  Vector3f point_m;
  ClosestPoint closest;
};

// Called for each triangle whose box is within the query's radius.
bool shorten(RTCPointQueryFunctionArguments* arguments) {
  Query& query = *static_cast<Query*>(arguments->userPtr);
  const auto& corners = query.mesh->triangles[arguments->primID];
  const auto& vertices = query.mesh->vertices_trf_m;
  const Vector3f closest =
      closest_point(query.point_m, vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]);
  const float distance_m = (closest - query.point_m).norm();
  if (!(distance_m < arguments->query->radius)) return false;
  arguments->query->radius = distance_m;
  query.closest = {distance_m, arguments->primID, closest};
  return true;
}

}  // namespace

Vector3f closest_point(const Vector3f& point, const Vector3f& a, const Vector3f& b, const Vector3f& c) {
  const Vector3f normal = (b - a).cross(c - a);
  const auto is_inside = [&](const Vector3f& from, const Vector3f& to) {
    return (to - from).cross(point - from).dot(normal) >= 0.0F;
  };
  const float square = normal.squaredNorm();
  if (square > 0.0F && is_inside(a, b) && is_inside(b, c) && is_inside(c, a))
    return point - normal.dot(point - a) / square * normal;
  Vector3f best = closest_on_segment(point, a, b);
  for (const Vector3f& other : {closest_on_segment(point, b, c), closest_on_segment(point, c, a)}) {
    if ((other - point).squaredNorm() < (best - point).squaredNorm()) best = other;
  }
  return best;
}

MeshDistance::MeshDistance(const TriangleMesh& mesh)
    : mesh_(mesh), scene_(std::make_unique<EmbreeScene>(mesh)) {}

MeshDistance::~MeshDistance() = default;

ClosestPoint MeshDistance::closest(const Vector3f& point_m) const {
  constexpr float kFarthest = std::numeric_limits<float>::infinity();
  RTCPointQuery query{point_m.x(), point_m.y(), point_m.z(), 0.0F, kFarthest};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  Query user{&mesh_, point_m, {kFarthest, 0, point_m}};
  rtcPointQuery(scene_->get(), &query, &context, shorten, &user);
  return user.closest;
}

float MeshDistance::largest_distance_m(const std::vector<Vector3f>& points_m) const {
  float largest_m = 0.0F;
  for (const Vector3f& point_m : points_m) largest_m = std::max(largest_m, distance_m(point_m));
  return largest_m;
}

}  // namespace tumblesight::sim
