#include "tests/unit/gnc/registration/scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>

namespace tumblesight::gnc {
namespace {

void put_u16(int value, std::vector<std::uint8_t>& bytes) {
  bytes.push_back(static_cast<std::uint8_t>(value));
  bytes.push_back(static_cast<std::uint8_t>(value >> 8));
}

std::array<int, 3> in_units(const Body& body, const Eigen::Vector3d& corner) {
  std::array<int, 3> units{};
  for (int i = 0; i < 3; ++i)
    units[static_cast<std::size_t>(i)] =
        static_cast<int>(std::lround(corner[i] / body.radius_m * SurfaceMesh::kRadius));
  return units;
}

// The corners opposite to each edge.
std::map<std::pair<int, int>, std::vector<int>> edges_of(const Body& body) {
  std::map<std::pair<int, int>, std::vector<int>> edges;
  for (const auto& [a, b, c] : body.triangles) {
    for (const auto& [first, second, opposite] :
         {std::array{a, b, c}, std::array{b, c, a}, std::array{c, a, b}})
      edges[std::minmax(first, second)].push_back(opposite);
  }
  return edges;
}

// Depth at which a ray meets a triangle (Moeller and Trumbore, 1997).
double depth_on(const Eigen::Vector3d& direction, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                const Eigen::Vector3d& c) {
  const Eigen::Vector3d along_b = b - a, along_c = c - a, normal = direction.cross(along_c);
  const double determinant = along_b.dot(normal);
  if (determinant == 0.0) return kNothing;
  const double u = -a.dot(normal) / determinant;
  const Eigen::Vector3d across = (-a).cross(along_b);
  const double v = direction.dot(across) / determinant;
  if (u < 0.0 || v < 0.0 || u + v > 1.0) return kNothing;
  const double depth = along_c.dot(across) / determinant;
  return depth > 0.0 ? depth : kNothing;
}

// Columns and rows that may meet the triangle: all of them if a corner is not before the sensor.
Eigen::AlignedBox2i rays_around(const Sensor& sensor, const std::array<Eigen::Vector3d, 3>& corners) {
  const Eigen::AlignedBox2i screen(Eigen::Vector2i(0, 0), Eigen::Vector2i(sensor.rays - 1, sensor.rays - 1));
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& corner : corners) {
    if (corner.y() < 0.01) return screen;
    box.extend(on_screen(sensor, corner).cwiseMax(-10.0).cwiseMin(sensor.rays + 10.0));
  }
  return screen.intersection(
      Eigen::AlignedBox2i((box.min().array() - 2.0).cast<int>(), (box.max().array() + 2.0).cast<int>()));
}

}  // namespace

void Body::add_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const int first = static_cast<int>(corners.size());
  for (int i = 0; i < 8; ++i)
    corners.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                         (i & 4) != 0 ? high.z() : low.z());
  for (const auto& [a, b, c, d] : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
                                   std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
    triangles.push_back({first + a, first + b, first + c});
    triangles.push_back({first + a, first + c, first + d});
  }
}

void Body::add_plate(double left, double right, double low, double high, double y) {
  const int first = static_cast<int>(corners.size());
  corners.emplace_back(left, y, low);
  corners.emplace_back(right, y, low);
  corners.emplace_back(right, y, high);
  corners.emplace_back(left, y, high);
  triangles.push_back({first, first + 1, first + 2});
  triangles.push_back({first, first + 2, first + 3});
}

Body lopsided_body() {
  Body body;
  body.radius_m = 2.5;
  body.add_box({-1.0, -0.8, -0.6}, {1.0, 0.8, 0.6});
  body.add_box({0.9, -0.6, 0.2}, {2.2, -0.2, 0.6});
  body.add_box({-0.8, 0.1, 0.5}, {-0.4, 0.7, 1.5});
  return body;
}

Body plate() {
  Body body;
  body.radius_m = 3.0;
  body.add_plate(-2.0, 2.0, -1.5, 1.5, 0.0);
  return body;
}

Body ball() {
  constexpr int kRings = 12, kSectors = 24;
  Body body;
  for (int ring = 0; ring <= kRings; ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) {
      const double polar = M_PI * ring / kRings, azimuth = 2.0 * M_PI * sector / kSectors;
      body.corners.emplace_back(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                std::cos(polar));
    }
  }
  for (int ring = 0; ring < kRings; ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) {
      const int next = (sector + 1) % kSectors, above = ring * kSectors, below = above + kSectors;
      body.triangles.push_back({above + sector, below + sector, below + next});
      body.triangles.push_back({above + sector, below + next, above + next});
    }
  }
  return body;
}

Body body_with_boom() {
  Body body;
  body.radius_m = 3.5;
  body.add_box({-0.9, -0.7, -0.6}, {0.6, 0.7, 0.8});
  body.add_box({0.6, -0.1, -0.5}, {2.5, 0.1, -0.3});
  return body;
}

MeshSection::MeshSection(const Body& body, Sides sides) {
  const auto edges = edges_of(body);
  put_u16(static_cast<int>(body.corners.size()), bytes_);
  put_u16(static_cast<int>(body.triangles.size()) * (sides == Sides::kBoth ? 2 : 1), bytes_);
  put_u16(static_cast<int>(edges.size()), bytes_);
  put_u16(0, bytes_);
  for (const Eigen::Vector3d& corner : body.corners)
    for (const int units : in_units(body, corner)) put_u16(units, bytes_);
  for (const auto& [a, b, c] : body.triangles) {
    for (const int corner : {a, b, c}) put_u16(corner, bytes_);
    if (sides == Sides::kFront) continue;
    for (const int corner : {a, c, b}) put_u16(corner, bytes_);
  }
  for (const auto& [ends, opposite] : edges) {
    for (const int corner : {ends.first, ends.second, opposite.front(), opposite.back()})
      put_u16(corner, bytes_);
  }
  EXPECT_TRUE(SurfaceMesh::is_sound(bytes_.data(), bytes_.size()));
}

Body rounded(const Body& body) {
  Body result = body;
  for (Eigen::Vector3d& corner : result.corners) {
    const auto [x, y, z] = in_units(body, corner);
    corner = body.radius_m / SurfaceMesh::kRadius * Eigen::Vector3d(x, y, z);
  }
  return result;
}

Pose fixed(const ExactPose& pose) {
  Pose result;
  for (int i = 0; i < 9; ++i) result.r_lrf_trf(i) = Fixed(pose.r_lrf_trf(i));
  for (int i = 0; i < 3; ++i)
    result.origin_lrf_um[static_cast<std::size_t>(i)] =
        static_cast<std::int32_t>(std::lround(1e6 * pose.origin_m[i]));
  return result;
}

ExactPose exact(const Pose& pose) {
  ExactPose result;
  for (int i = 0; i < 9; ++i) result.r_lrf_trf(i) = pose.r_lrf_trf(i).raw() / 16777216.0;
  for (int i = 0; i < 3; ++i) result.origin_m[i] = 1e-6 * pose.origin_lrf_um[static_cast<std::size_t>(i)];
  return result;
}

ExactPose moved(const ExactPose& pose, const Eigen::Vector3d& turn_rad, const Eigen::Vector3d& move_m) {
  const double angle = turn_rad.norm();
  const Eigen::Vector3d axis = angle > 0.0 ? Eigen::Vector3d(turn_rad / angle) : Eigen::Vector3d::UnitX();
  return {Eigen::AngleAxisd(angle, axis) * pose.r_lrf_trf, pose.origin_m + move_m};
}

Eigen::Vector3d ray(const Sensor& sensor, double row, double column) {
  return {sensor.tan_half_fov() * ((2.0 * column + 1.0) / sensor.rays - 1.0), 1.0,
          sensor.tan_half_fov() * (1.0 - (2.0 * row + 1.0) / sensor.rays)};
}

Eigen::Vector2d on_screen(const Sensor& sensor, const Eigen::Vector3d& point_m) {
  const double rays_per_slope = 0.5 * sensor.rays / sensor.tan_half_fov();
  return {0.5 * sensor.rays + rays_per_slope * point_m.x() / point_m.y(),
          0.5 * sensor.rays - rays_per_slope * point_m.z() / point_m.y()};
}

std::vector<double> cast(const Body& body, const ExactPose& pose, const Sensor& sensor) {
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector3d& corner : body.corners)
    corners.emplace_back(pose.r_lrf_trf * corner + pose.origin_m);
  std::vector<double> depths(static_cast<std::size_t>(sensor.rays * sensor.rays), kNothing);
  for (const auto& triangle : body.triangles) {
    const Eigen::Vector3d &a = corners[static_cast<std::size_t>(triangle[0])],
                          &b = corners[static_cast<std::size_t>(triangle[1])],
                          &c = corners[static_cast<std::size_t>(triangle[2])];
    const Eigen::AlignedBox2i rays = rays_around(sensor, {a, b, c});
    for (int row = rays.min().y(); row <= rays.max().y(); ++row) {
      for (int column = rays.min().x(); column <= rays.max().x(); ++column) {
        double& nearest = depths[static_cast<std::size_t>(row * sensor.rays + column)];
        nearest = std::min(nearest, depth_on(ray(sensor, row, column), a, b, c));
      }
    }
  }
  return depths;
}

Frame::Frame(const Sensor& sensor) {
  image->rays = static_cast<std::uint16_t>(sensor.rays);
  image->fov_urad = static_cast<std::uint32_t>(std::lround(sensor.fov_deg * M_PI / 180.0 * 1e6));
  *mask = {};
}

void Frame::add(int row, int column, double range_m) {
  hide(row, column, range_m);
  if (range_m <= 0.0) return;
  mask->rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column / RayMask::kColumnsPerWord)] |=
      1U << (31 - column % RayMask::kColumnsPerWord);
}

void Frame::hide(int row, int column, double range_m) {
  image->ranges[static_cast<std::size_t>(row * image->rays + column)] =
      static_cast<std::uint16_t>(std::lround(std::max(0.0, range_m) * 128.0));
}

Frame frame_of(const std::vector<double>& depths_m, const Sensor& sensor) {
  Frame frame(sensor);
  for (int i = 0; i < sensor.rays * sensor.rays; ++i) {
    const double depth_m = depths_m[static_cast<std::size_t>(i)];
    const int row = i / sensor.rays, column = i % sensor.rays;
    if (depth_m != kNothing) frame.add(row, column, depth_m * ray(sensor, row, column).norm());
  }
  return frame;
}

std::unique_ptr<FrameView> view_of(const Frame& frame, double reference_depth_m, double radius_m,
                                   const RangeNoise& noise) {
  auto view = std::make_unique<FrameView>();
  EXPECT_TRUE(make_frame_view(*frame.image, *frame.mask,
                              static_cast<std::int32_t>(std::lround(1e6 * reference_depth_m)),
                              static_cast<std::uint32_t>(std::lround(1e3 * radius_m)), noise, *view));
  return view;
}

std::unique_ptr<FrameView> empty_view(const Sensor& sensor, double reference_depth_m, double radius_m) {
  return view_of(Frame(sensor), reference_depth_m, radius_m);
}

void show(const std::vector<std::int16_t>& rays, FrameView& view) {
  view.returned = view.hidden = {};
  std::map<std::pair<int, int>, std::vector<double>> blocks;
  for (int row = 0; row < view.rays; ++row) {
    for (int column = 0; column < view.rays; ++column) {
      const std::int16_t shown = rays[static_cast<std::size_t>(row * view.rays + column)];
      if (shown == kMissed) continue;
      RayMask& mask = shown == kHidden ? view.hidden : view.returned;
      mask.rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column / 32)] |=
          0x8000'0000U >> (column % 32);
      if (shown != kHidden) blocks[{row / 2, column / 2}].push_back(shown);
    }
  }
  for (const auto& [block, values] : blocks) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    view.block_inverse_depth[static_cast<std::size_t>(block.first * FrameView::kMaxBlocks + block.second)] =
        static_cast<std::int16_t>(std::lround(sum / static_cast<double>(values.size())));
  }
}

void show_all(std::int16_t shown, FrameView& view) {
  show(std::vector<std::int16_t>(static_cast<std::size_t>(view.rays * view.rays), shown), view);
}

void show_random_returns(Random& random, FrameView& view) {
  std::vector<std::int16_t> rays(static_cast<std::size_t>(view.rays * view.rays));
  for (std::int16_t& ray : rays) ray = random.happens(0.5) ? std::int16_t{0} : kMissed;
  show(rays, view);
}

double inverse_depth_of(const FrameView& view, double depth_m) {
  return (1e-6 * view.reference_depth_um / depth_m - 1.0) * std::ldexp(1.0, view.shift);
}

}  // namespace tumblesight::gnc
