#include "gnc/registration/surface_renderer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/trials.hpp"
#include "tests/unit/gnc/registration/scene.hpp"

namespace tumblesight::gnc {
namespace {

// A vertex that the renderer draws: within so many rays of the middle of the screen, and between these shares
// of the reference depth.
constexpr double kFarthest_rays = RangeImage::kMaxRays;
constexpr double kLeastDepth = 0.5, kLargestDepth = 4.0;

std::unique_ptr<Rendering> rendered(const Body& body, const FrameView& view, const Pose& pose,
                                    MeshSection::Sides sides = MeshSection::Sides::kBoth) {
  const MeshSection section(body, sides);
  auto surface = std::make_unique<Rendering>();
  render(section.mesh(), view, pose, *surface, surface->budget);
  return surface;
}

bool is_filled(const RenderedSurface& surface) {
  return std::any_of(surface.inverse_depth.begin(), surface.inverse_depth.end(),
                     [](std::int16_t inverse_depth) { return inverse_depth != RenderedSurface::kEmpty; });
}

// A body at a pose, in double precision.
class Expected {
 public:
  Expected(const Body& body, const ExactPose& pose, const Sensor& sensor)
      : body_(body), pose_(pose), sensor_(sensor), depths_m_(cast(body, pose, sensor)) {
    for (const Eigen::Vector3d& corner : body.corners) {
      points_m_.emplace_back(pose.r_lrf_trf * corner + pose.origin_m);
      places_.push_back(on_screen(sensor, points_m_.back()));
    }
  }
  double depth_m(int row, int column) const {
    return depths_m_[static_cast<std::size_t>(row * sensor_.rays + column)];
  }
  // From the middle of a ray to the nearest edge of any triangle [rays].
  double distance_from_edges(int row, int column) const {
    const Eigen::Vector2d place(column + 0.5, row + 0.5);
    double nearest = 1e9;
    for (const auto& triangle : body_.triangles) {
      for (std::size_t i = 0; i < 3; ++i)
        nearest = std::min(nearest, distance(place, places_[static_cast<std::size_t>(triangle[i])],
                                             places_[static_cast<std::size_t>(triangle[(i + 1) % 3])]));
    }
    return nearest;
  }
  // Largest change of the inverse depth of any plane on a ray when the ray moves by `step_rays`.
  double slope(const FrameView& view, int row, int column, double step_rays) const {
    double largest = 0.0;
    for (const auto& [a, b, c] : body_.triangles) {
      const Eigen::Vector3d &p = points_m_[static_cast<std::size_t>(a)],
                            &q = points_m_[static_cast<std::size_t>(b)],
                            &r = points_m_[static_cast<std::size_t>(c)];
      const std::array<int, 3> corners{a, b, c};
      if (!contains(corners, Eigen::Vector2d(column + 0.5, row + 0.5))) continue;
      const Eigen::Vector3d normal = (q - p).cross(r - p);
      const auto inverse_depth = [&](double at_row, double at_column) {
        return inverse_depth_of(view, normal.dot(p) / normal.dot(ray(sensor_, at_row, at_column)));
      };
      largest = std::max(largest,
                         std::abs(inverse_depth(row + step_rays, column) - inverse_depth(row, column)) +
                             std::abs(inverse_depth(row, column + step_rays) - inverse_depth(row, column)));
    }
    return largest;
  }

 private:
  static double distance(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const double square = (b - a).squaredNorm();
    const double part = square > 0.0 ? std::clamp((p - a).dot(b - a) / square, 0.0, 1.0) : 0.0;
    return (p - a - part * (b - a)).norm();
  }
  bool contains(const std::array<int, 3>& triangle, const Eigen::Vector2d& p) const {
    int positive = 0, negative = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector2d &a = places_[static_cast<std::size_t>(triangle[i])],
                            &b = places_[static_cast<std::size_t>(triangle[(i + 1) % 3])];
      const double area = (b - a).x() * (p - a).y() - (b - a).y() * (p - a).x();
      positive += area > 0.0 ? 1 : 0;
      negative += area < 0.0 ? 1 : 0;
    }
    return positive == 0 || negative == 0;
  }

  const Body& body_;
  const ExactPose& pose_;
  Sensor sensor_;
  std::vector<double> depths_m_;
  std::vector<Eigen::Vector3d> points_m_;
  std::vector<Eigen::Vector2d> places_;
};

// The silhouette is right within 1/64 of a ray and the rounding of the vertices; the inverse depth within 4
// counts and the change over that distance. Where a plane is nearly edge on, that rounding changes its slope
// too, and only the silhouette is compared.
void expect_as_cast(const Body& exact_body, const Pose& pose, const Sensor& sensor, double depth_m) {
  const Body body = rounded(exact_body);
  const auto view = empty_view(sensor, depth_m, body.radius_m);
  const auto surface = rendered(body, *view, pose);
  const Expected expected(body, exact(pose), sensor);
  const double rounding_rays = 1.0 / 64.0 + view->rays_per_radius_q8 / 256.0 * 3.0 / SurfaceMesh::kRadius;
  EXPECT_TRUE(surface->is_complete);
  constexpr double kEdgeOn = 100.0;  // counts
  int wrong = 0, far_off = 0;
  for (int row = 0; row < sensor.rays; ++row) {
    for (int column = 0; column < sensor.rays; ++column) {
      const double true_depth_m = expected.depth_m(row, column);
      const std::int16_t inverse_depth = surface->at(row, column);
      const bool is_wrong = surface->is_filled(row, column) != (true_depth_m != kNothing);
      const double error = is_wrong ? 1e9 : inverse_depth - inverse_depth_of(*view, true_depth_m);
      if (!is_wrong && (true_depth_m == kNothing || std::abs(error) <= 4.0)) continue;
      if (expected.distance_from_edges(row, column) <= rounding_rays) continue;
      wrong += is_wrong ? 1 : 0;
      const double change = expected.slope(*view, row, column, rounding_rays);
      if (!is_wrong && change < kEdgeOn && std::abs(error) > 4.0 + change) ++far_off;
    }
  }
  EXPECT_EQ(wrong, 0) << "filled rays";
  EXPECT_EQ(far_off, 0) << "inverse depth";
}

TEST(SurfaceRenderer, BodyIsAsARayCasterSeesIt) {
  Random random(1);
  for (const double fov_deg : {4.0, 20.0, 40.0}) {
    for (const int rays : {16, 65, 128}) {
      for (int i = 0; i < trials(8); ++i) {
        const Sensor sensor{rays, fov_deg};
        // From a target that fills the view, but is no nearer than 2.1 radii, to one of a quarter of it.
        const double nearest_m = std::max(2.1 * 2.5, 2.5 / sensor.tan_half_fov());
        const double depth_m = std::min(500.0, nearest_m * random.uniform(1.0, 4.0));
        const double across_m = 0.5 * depth_m * sensor.tan_half_fov();
        const Eigen::Vector3d origin_m(across_m * random.uniform(-1.0, 1.0),
                                       depth_m + random.uniform(-0.5, 0.5),
                                       across_m * random.uniform(-1.0, 1.0));
        SCOPED_TRACE(testing::Message() << fov_deg << " deg, " << rays << " rays, " << i);
        expect_as_cast(lopsided_body(), fixed({random.rotation(), origin_m}), sensor, depth_m);
      }
    }
  }
}

TEST(SurfaceRenderer, FarthestTargetIsAsARayCasterSeesIt) {
  Random random(2);
  for (int i = 0; i < trials(8); ++i)
    expect_as_cast(lopsided_body(), fixed({random.rotation(), {1.0, 500.0, -1.0}}), {128, 1.0}, 500.0);
}

TEST(SurfaceRenderer, TargetPartlyOutOfViewIsAsARayCasterSeesIt) {
  Random random(3);
  const Sensor sensor{64, 20.0};
  for (int i = 0; i < trials(24); ++i) {
    const double edge_m = 20.0 * sensor.tan_half_fov();
    const double across_m = i % 2 == 0 ? edge_m : -edge_m, along_m = random.uniform(-edge_m, edge_m);
    const bool is_sideways = i % 4 < 2;
    const Eigen::Vector3d origin_m(is_sideways ? across_m : along_m, 20.0, is_sideways ? along_m : across_m);
    SCOPED_TRACE(i);
    expect_as_cast(lopsided_body(), fixed({random.rotation(), origin_m}), sensor, 20.0);
  }
}

// Of 128 rays a side, so that its corners beyond the screen are still drawn.
TEST(SurfaceRenderer, TiltedTriangleThatCoversTheScreenIsAsARayCasterSeesIt) {
  Random random(4);
  Body body;
  body.radius_m = 5.0;
  body.corners = {{-4.5, 0.0, -2.1}, {4.5, 0.0, -2.1}, {0.0, 0.0, 4.9}};
  body.triangles = {{0, 1, 2}};
  const Sensor sensor{64, 6.0};
  for (int i = 0; i < trials(16); ++i) {
    const Eigen::Vector3d turn_rad = {random.uniform(-0.9, 0.9), random.uniform(-3.1, 3.1),
                                      random.uniform(-0.9, 0.9)};
    const Eigen::Vector3d move_m = random.vector(0.1);
    const ExactPose pose = moved({Eigen::Matrix3d::Identity(), {0.0, 25.0, 0.0}}, turn_rad, move_m);
    SCOPED_TRACE(i);
    expect_as_cast(body, fixed(pose), sensor, 25.0);
  }
}

// Neighbouring triangles share their vertices: no ray falls between them, and none is added around them.
TEST(SurfaceRenderer, MeshOfManySmallTrianglesHasNoHoles) {
  Random random(5);
  constexpr int kSide = 38;
  Body body;
  body.radius_m = 3.0;
  for (int i = 0; i <= kSide; ++i) {
    for (int k = 0; k <= kSide; ++k) {
      const bool is_inside = i > 0 && k > 0 && i < kSide && k < kSide;
      const double jitter = is_inside ? 0.4 : 0.0;
      body.corners.emplace_back(4.0 * (i + jitter * random.uniform(-1.0, 1.0)) / kSide - 2.0, 0.0,
                                4.0 * (k + jitter * random.uniform(-1.0, 1.0)) / kSide - 2.0);
      if (i == kSide || k == kSide) continue;
      const int first = i * (kSide + 1) + k;
      body.triangles.push_back({first, first + 1, first + kSide + 2});
      body.triangles.push_back({first, first + kSide + 2, first + kSide + 1});
    }
  }
  Body silhouette;
  silhouette.radius_m = 3.0;
  silhouette.add_plate(-2.0, 2.0, -2.0, 2.0, 0.0);
  const Sensor sensor{128, 20.0};
  const auto view = empty_view(sensor, 15.0, body.radius_m);
  for (int i = 0; i < trials(4); ++i) {
    const ExactPose pose =
        moved({Eigen::Matrix3d::Identity(), {0.0, 15.0, 0.0}}, random.vector(0.3), Eigen::Vector3d::Zero());
    const auto small = rendered(body, *view, fixed(pose)), large = rendered(silhouette, *view, fixed(pose));
    ASSERT_TRUE(small->is_complete);
    int difference = 0, filled = 0;
    for (int row = 0; row < sensor.rays; ++row) {
      for (int column = 0; column < sensor.rays; ++column) {
        filled += large->is_filled(row, column) ? 1 : 0;
        difference += small->is_filled(row, column) != large->is_filled(row, column) ? 1 : 0;
      }
    }
    EXPECT_GT(filled, 4000);
    EXPECT_LE(difference, 4) << "of the silhouette's rounded vertices";
  }
}

TEST(SurfaceRenderer, TriangleIsDrawnFromItsFrontOnly) {
  Body body;
  body.radius_m = 2.0;
  body.corners = {{-1.0, 0.0, -1.0}, {1.0, 0.0, -1.0}, {0.0, 0.0, 1.0}};
  body.triangles = {{0, 1, 2}};
  const auto view = empty_view({64, 20.0}, 20.0, body.radius_m);
  const auto is_drawn = [&](double turn_rad) {
    const ExactPose pose =
        moved({Eigen::Matrix3d::Identity(), {0.0, 20.0, 0.0}}, {0.0, 0.0, turn_rad}, Eigen::Vector3d::Zero());
    return is_filled(*rendered(body, *view, fixed(pose), MeshSection::Sides::kFront));
  };
  for (const double turn_rad : {-1.4, -0.5, 0.0, 0.5, 1.4}) {
    EXPECT_TRUE(is_drawn(turn_rad)) << "counterclockwise as seen from the sensor";
    EXPECT_FALSE(is_drawn(M_PI + turn_rad));
  }
}

// Closed bodies: what is behind them does not matter, to one count of the first corner of a triangle.
TEST(SurfaceRenderer, FrontsOfClosedBodiesAreEnough) {
  Random random(10);
  const Body body = lopsided_body();
  const auto view = empty_view({128, 20.0}, 20.0, body.radius_m);
  for (int i = 0; i < trials(20); ++i) {
    const Pose pose = fixed({random.rotation(), {0.3, 20.0, -0.2}});
    const auto both = rendered(body, *view, pose);
    const auto fronts = rendered(body, *view, pose, MeshSection::Sides::kFront);
    ASSERT_TRUE(is_filled(*fronts));
    int different = 0;
    for (std::size_t ray = 0; ray < both->inverse_depth.size(); ++ray)
      different += std::abs(both->inverse_depth[ray] - fronts->inverse_depth[ray]) > 1 ? 1 : 0;
    EXPECT_LE(different, 8) << "on the silhouette of a face that shows its back";
  }
}

TEST(SurfaceRenderer, FilledRaysAreThoseWithAnInverseDepth) {
  Random random(11);
  for (const int rays : {16, 65, 128}) {
    const Body body = lopsided_body();
    const auto view = empty_view({rays, 20.0}, 12.0, body.radius_m);
    for (int i = 0; i < trials(20); ++i) {
      const auto surface = rendered(body, *view, fixed({random.rotation(), {1.0, 12.0, -0.9}}));
      for (int row = 0; row < rays; ++row)
        for (int column = 0; column < rays; ++column)
          ASSERT_EQ(surface->is_filled(row, column), surface->at(row, column) != RenderedSurface::kEmpty);
    }
  }
}

TEST(SurfaceRenderer, NearestSurfaceWinsInAnyOrderOfTheTriangles) {
  Random random(6);
  Body body = lopsided_body();
  const auto view = empty_view({64, 20.0}, 20.0, body.radius_m);
  const Pose pose = fixed({random.rotation(), {0.3, 20.0, -0.2}});
  const auto first = rendered(body, *view, pose);
  ASSERT_TRUE(is_filled(*first));
  for (int i = 0; i < 10; ++i) {
    for (std::size_t k = body.triangles.size() - 1; k > 0; --k)
      std::swap(body.triangles[k],
                body.triangles[static_cast<std::size_t>(random.below(static_cast<int>(k) + 1))]);
    EXPECT_EQ(rendered(body, *view, pose)->inverse_depth, first->inverse_depth) << i;
  }
}

// Up to one count, since a triangle's inverse depth is computed from its first corner.
TEST(SurfaceRenderer, OrderOfATrianglesCornersDoesNotMatter) {
  Body body = plate();
  const auto view = empty_view({64, 20.0}, 20.0, body.radius_m);
  const Pose pose = fixed(
      moved({Eigen::Matrix3d::Identity(), {0.0, 20.0, 0.0}}, {0.4, 0.3, -0.2}, Eigen::Vector3d::Zero()));
  const auto first = rendered(body, *view, pose);
  for (int i = 0; i < 6; ++i) {
    for (auto& triangle : body.triangles) std::next_permutation(triangle.begin(), triangle.end());
    const auto other = rendered(body, *view, pose);
    for (int ray = 0; ray < 64 * 64; ++ray) {
      const auto at = static_cast<std::size_t>(ray);
      ASSERT_EQ(other->inverse_depth[at] == RenderedSurface::kEmpty,
                first->inverse_depth[at] == RenderedSurface::kEmpty);
      ASSERT_NEAR(other->inverse_depth[at], first->inverse_depth[at], 1.0);
    }
  }
}

TEST(SurfaceRenderer, VerticesAreOnTheScreenWhereTheyAreSeen) {
  Random random(7);
  const Body body = rounded(lopsided_body());
  for (const Sensor sensor : {Sensor{16, 40.0}, Sensor{128, 10.0}}) {
    const auto view = empty_view(sensor, 30.0, body.radius_m);
    for (int i = 0; i < trials(50); ++i) {
      const Pose pose = fixed({random.rotation(), {0.5, 30.0, -0.7}});
      const auto surface = rendered(body, *view, pose);
      for (std::size_t k = 0; k < body.corners.size(); ++k) {
        const Eigen::Vector3d point_m = exact(pose).r_lrf_trf * body.corners[k] + exact(pose).origin_m;
        const Eigen::Vector2d place = 64.0 * on_screen(sensor, point_m);
        ASSERT_NEAR(surface->memory[k].column, place.x(), 0.8);
        ASSERT_NEAR(surface->memory[k].row, place.y(), 0.8);
        ASSERT_NEAR(surface->memory[k].inverse_depth, inverse_depth_of(*view, point_m.y()), 2.0);
      }
    }
  }
}

// A small plate that is moved over the limit.
TEST(SurfaceRenderer, TrianglesBeyondTheLimitsOfDepthOrScreenAreNotDrawn) {
  Body body;
  body.radius_m = 2.0;
  body.add_plate(-0.1, 0.1, -0.1, 0.1, 0.0);
  const Sensor sensor{128, 20.0};
  const double depth_m = 20.0;
  const auto view = empty_view(sensor, depth_m, body.radius_m);
  const auto is_outside = [&](const Eigen::Vector3d& origin_m) {
    const auto surface = rendered(body, *view, fixed({Eigen::Matrix3d::Identity(), origin_m}));
    return surface->memory[0].is_outside();
  };
  EXPECT_FALSE(is_outside({0.0, depth_m, 0.0}));
  const double beyond_m = 1.05 * depth_m * sensor.tan_half_fov() * 2.0 * kFarthest_rays / sensor.rays;
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_FALSE(is_outside({0.9 * sign * beyond_m, depth_m, 0.0}));
    EXPECT_FALSE(is_outside({0.0, depth_m, 0.9 * sign * beyond_m}));
    EXPECT_TRUE(is_outside({sign * beyond_m, depth_m, 0.0}));
    EXPECT_TRUE(is_outside({0.0, depth_m, sign * beyond_m}));
  }
}

TEST(SurfaceRenderer, NothingIsDrawnOfATargetBesideOrBehindTheSensor) {
  const Body body = lopsided_body();
  const auto view = empty_view({64, 20.0}, 20.0, body.radius_m);
  for (const Eigen::Vector3d& origin_m : std::initializer_list<Eigen::Vector3d>{{0.0, -20.0, 0.0},
                                                                                {0.0, 0.0, 0.0},
                                                                                {0.0, -2000.0, 0.0},
                                                                                {0.0, 2000.0, 0.0},
                                                                                {20.0, 20.0, 0.0},
                                                                                {0.0, 20.0, -20.0},
                                                                                {-2000.0, 20.0, 2000.0},
                                                                                {2000.0, 2000.0, 2000.0},
                                                                                {2000.0, -2000.0, -2000.0}}) {
    const auto surface = rendered(body, *view, fixed({Eigen::Matrix3d::Identity(), origin_m}));
    EXPECT_FALSE(is_filled(*surface)) << origin_m.transpose();
    EXPECT_FALSE(surface->is_complete);
  }
}

TEST(SurfaceRenderer, NothingIsDrawnOfAMeshWithoutTrianglesOrWithFlatOnes) {
  const auto view = empty_view({64, 20.0}, 20.0, 2.0);
  const Pose pose = fixed({Eigen::Matrix3d::Identity(), {0.0, 20.0, 0.0}});
  auto surface = std::make_unique<Rendering>();
  render(SurfaceMesh(), *view, pose, *surface, surface->budget);
  EXPECT_FALSE(is_filled(*surface));
  Body body;
  body.radius_m = 2.0;
  body.corners = {{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.5, 0.3, 0.0}};
  body.triangles = {{0, 0, 1}, {0, 1, 2}};  // without an area; edge on
  EXPECT_FALSE(is_filled(*rendered(body, *view, pose)));
}

// Beyond the rays of the frame the buffer stays as it was filled.
TEST(SurfaceRenderer, WritesOnlyTheRaysOfTheFrame) {
  Random random(8);
  for (const int rays : {16, 33, 64}) {
    const auto view = empty_view({rays, 20.0}, 6.0, 2.5);
    for (int i = 0; i < trials(20); ++i) {
      const auto surface = rendered(lopsided_body(), *view, fixed({random.rotation(), {0.1, 6.0, 0.2}}));
      ASSERT_EQ(surface->rays, rays);
      for (std::size_t k = static_cast<std::size_t>(rays) * static_cast<std::size_t>(rays);
           k < surface->inverse_depth.size(); ++k)
        ASSERT_EQ(surface->inverse_depth[k], RenderedSurface::kEmpty);
    }
    const auto surface = rendered(lopsided_body(), *view, fixed({random.rotation(), {0.1, 6.0, 0.2}}));
    for (const int beyond : {-1000, -1, rays, 1000}) {
      EXPECT_EQ(surface->at(beyond, 0), RenderedSurface::kEmpty);
      EXPECT_EQ(surface->at(0, beyond), RenderedSurface::kEmpty);
      EXPECT_FALSE(surface->is_filled(rays / 2, beyond));
    }
  }
}

// Each triangle of the stack covers all of the screen.
TEST(SurfaceRenderer, WorkOfARenderingIsLimited) {
  const Sensor sensor{128, 4.0};
  const Pose pose = fixed({Eigen::Matrix3d::Identity(), {0.0, 50.0, 0.0}});
  Body body;
  body.radius_m = 5.0;
  const auto view = empty_view(sensor, 50.0, body.radius_m);
  body.add_plate(-2.5, 2.5, -2.5, 2.5, 0.0);
  EXPECT_TRUE(rendered(body, *view, pose)->is_complete);
  for (int i = 0; i < 100; ++i) body.add_plate(-2.5, 2.5, -2.5, 2.5, 0.01 * i);
  const auto limited = rendered(body, *view, pose);
  EXPECT_FALSE(limited->is_complete);
  // What is there by then stays.
  EXPECT_TRUE(limited->is_filled(64, 64));
  EXPECT_NEAR(limited->at(64, 64), 0.0, 2.0);
}

TEST(SurfaceRenderer, TurnedVertexIsRotatedWithinTwoUnits) {
  Random random(9);
  for (int i = 0; i < trials(1000); ++i) {
    const Pose pose = fixed({random.rotation(), {}});
    SurfaceMesh::Vertex vertex{};
    for (std::int32_t& number : vertex) number = static_cast<std::int32_t>(random.below(65'535)) - 32'767;
    const Eigen::Vector3d exact_arm =
        exact(pose).r_lrf_trf * Eigen::Vector3d(vertex[0], vertex[1], vertex[2]);
    const Arm arm = Turn(pose.r_lrf_trf)(vertex);
    for (int k = 0; k < 3; ++k) ASSERT_NEAR(arm[static_cast<std::size_t>(k)], exact_arm[k], 2.0);
  }
}

}  // namespace
}  // namespace tumblesight::gnc
