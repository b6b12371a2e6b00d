// Verifies TS-SIL-070.
#include "sim/world/sensor/flash_lidar.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "sim/world/scenario/condition.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kCount_m = 1.0 / 128.0;

TriangleMesh square(double half_m) {
  const auto h = static_cast<float>(half_m);
  return {"square", {{-h, 0, -h}, {h, 0, -h}, {h, 0, h}, {-h, 0, h}}, {{0, 1, 2}, {0, 2, 3}}};
}

TriangleMesh box(float h) {
  TriangleMesh mesh{"box", {}, {}};
  for (int i = 0; i < 8; ++i)
    mesh.vertices_trf_m.emplace_back(i & 1 ? h : -h, i & 2 ? h : -h, i & 4 ? h : -h);
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return mesh;
}

TriangleMesh sphere(double radius_m, int rings) {
  TriangleMesh mesh{"sphere", {}, {}};
  const int around = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < around; ++j) {
      const double a = M_PI * i / rings, b = 2.0 * M_PI * j / around;
      mesh.vertices_trf_m.push_back(
          (radius_m * Eigen::Vector3d(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)))
              .cast<float>());
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * around + j % around); };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < around; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

FrameTruth truth(double range_m, const Eigen::Quaterniond& q = Eigen::Quaterniond::Identity()) {
  return {q, Eigen::Vector3d::Zero(), range_m};
}

std::unique_ptr<gnc::RangeImage> expose(const TriangleMesh& mesh, const FrameTruth& t, double swath,
                                        int rays = 128) {
  auto frame = std::make_unique<gnc::RangeImage>();
  SensorSettings settings;
  settings.noise = false;
  settings.rays = rays;
  FlashLidar(mesh).expose(t, settings, swath, 1, *frame);
  return frame;
}

// Compares every ray with the closed form; infinity: no hit. Rays that are kUndecided are skipped.
void compare(const gnc::RangeImage& frame, double tolerance_m,
             const std::function<double(const Eigen::Vector3d&)>& range_along) {
  const double t = std::tan(frame.fov_urad * 0.5e-6);
  int hits = 0;
  for (int row = 0; row < frame.rays; ++row) {
    for (int column = 0; column < frame.rays; ++column) {
      const Eigen::Vector3d d = Eigen::Vector3d(t * ((2.0 * column + 1) / frame.rays - 1), 1.0,
                                                t * (1 - (2.0 * row + 1) / frame.rays))
                                    .normalized();
      const double expected_m = range_along(d);
      if (std::isnan(expected_m)) continue;
      const double measured_m = frame.ranges[row * frame.rays + column] * kCount_m;
      hits += measured_m > 0.0 ? 1 : 0;
      if (std::isinf(expected_m)) {
        ASSERT_EQ(measured_m, 0.0) << row << ' ' << column;
      } else {
        ASSERT_NEAR(measured_m, expected_m, tolerance_m) << row << ' ' << column;
      }
    }
  }
  ASSERT_GT(hits, 1000);
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUndecided = std::numeric_limits<double>::quiet_NaN();

TEST(FlashLidar, SeesAPlaneAtItsClosedFormRangeFromBothSides) {
  for (const double turn : {0.3, 0.3 + M_PI}) {
    const Eigen::Quaterniond q(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()));
    const Eigen::Vector3d normal = q * Eigen::Vector3d::UnitY();
    const Eigen::Vector3d centre(0, 30, 0);
    const auto frame = expose(square(2.0), truth(30.0, q), 6.0);
    compare(*frame, 0.6 * kCount_m, [&](const Eigen::Vector3d& d) {
      const double s = normal.dot(centre) / normal.dot(d);
      const Eigen::Vector3d p = q.conjugate() * (s * d - centre);
      const double outside = std::max(std::abs(p.x()), std::abs(p.z())) - 2.0;
      return std::abs(outside) < 1e-3 ? kUndecided : outside > 0 ? kInfinity : s;
    });
  }
}

TEST(FlashLidar, SeesASphereAtItsClosedFormRange) {
  const auto frame = expose(sphere(2.0, 200), truth(25.0), 6.0);
  compare(*frame, 0.02, [&](const Eigen::Vector3d& d) {
    const double b = 25.0 * d.y();
    const double discriminant = b * b - (25.0 * 25.0 - 4.0);
    if (std::abs(discriminant) < 0.1) return kUndecided;  // grazing: the facets differ from the sphere
    return discriminant < 0 ? kInfinity : b - std::sqrt(discriminant);
  });
}

TEST(FlashLidar, SeesATurnedBoxAtItsClosedFormRange) {
  const Eigen::Quaterniond q(Eigen::Quaterniond(0.9, 0.3, -0.2, 0.25).normalized());
  const auto frame = expose(box(1.5F), truth(40.0, q), 6.0, 100);
  const Eigen::Vector3d origin = q.conjugate() * Eigen::Vector3d(0, -40, 0);
  compare(*frame, 0.6 * kCount_m, [&](const Eigen::Vector3d& d_lrf) {
    const Eigen::Vector3d d = q.conjugate() * d_lrf;
    double enter = 0.0, leave = kInfinity;
    for (int i = 0; i < 3; ++i) {  // slabs
      const double a = (-1.5 - origin[i]) / d[i], b = (1.5 - origin[i]) / d[i];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (std::abs(enter - leave) < 5e-3) return kUndecided;
    return enter > leave ? kInfinity : enter;
  });
}

TEST(FlashLidar, NoiseIsGaussianAlongTheRayWithThePapersSigma) {
  for (const double range_m : {20.0, 100.0}) {
    const FlashLidar lidar(square(20.0));
    auto frame = std::make_unique<gnc::RangeImage>();
    auto exact = std::make_unique<gnc::RangeImage>();
    SensorSettings settings;
    lidar.expose(truth(range_m), settings, 3.0, 42, *frame);
    settings.noise = false;
    lidar.expose(truth(range_m), settings, 3.0, 42, *exact);
    double sum = 0, squares = 0, fourth = 0;
    const int n = 128 * 128;
    const double sigma_m = 0.1 + 0.01 * range_m;
    for (int i = 0; i < n; ++i) {
      const double z = (frame->ranges[i] - exact->ranges[i]) * kCount_m / sigma_m;
      sum += z;
      squares += z * z;
      fourth += z * z * z * z;
    }
    EXPECT_NEAR(sum / n, 0.0, 0.03);  // 4 sigma of the mean of 16,384
    EXPECT_NEAR(squares / n, 1.0, 0.045);
    EXPECT_NEAR(fourth / n, 3.0, 0.35);  // kurtosis of a Gaussian
  }
}

TEST(FlashLidar, DegradedHasAHundredRaysAndLosesATenthOfTheReturns) {
  const FlashLidar lidar(square(20.0));
  auto frame = std::make_unique<gnc::RangeImage>();
  lidar.expose(truth(30.0), sensor_settings(Condition::kDegraded), 3.0, 5, *frame);
  ASSERT_EQ(frame->rays, 100);
  int lost = 0;
  for (int i = 0; i < 100 * 100; ++i) lost += frame->ranges[i] == 0 ? 1 : 0;
  EXPECT_NEAR(lost / 10000.0, 0.1, 0.012);
}

TEST(FlashLidar, SameSeedSameFrameAndAnotherSeedAnother) {
  const FlashLidar lidar(box(1.0F));
  auto a = std::make_unique<gnc::RangeImage>(), b = std::make_unique<gnc::RangeImage>(),
       c = std::make_unique<gnc::RangeImage>();
  lidar.expose(truth(30.0), {}, 4.0, 5, *a);
  lidar.expose(truth(30.0), {}, 4.0, 5, *b);
  lidar.expose(truth(30.0), {}, 4.0, 6, *c);
  EXPECT_EQ(a->ranges, b->ranges);
  EXPECT_NE(a->ranges, c->ranges);
}

TEST(FlashLidar, AnOccluderWithoutAShapeChangesNoBit) {
  const FlashLidar lidar(box(1.0F));
  FrameTruth open = truth(30.0), covered = truth(30.0);
  covered.occluder = {OccluderShape::kNone, 1.0, 0.5, 0.3, 3.0};
  auto a = std::make_unique<gnc::RangeImage>(), b = std::make_unique<gnc::RangeImage>();
  lidar.expose(open, {}, 4.0, 5, *a);
  lidar.expose(covered, {}, 4.0, 5, *b);
  EXPECT_EQ(a->ranges, b->ranges);
  // The number of returns agrees with the closed form: 2 m of 4 m at 29 m, seen from 30 m.
  const double side = 128.0 * 2.0 / 4.0 * 30.0 / 29.0;
  const auto returns =
      std::count_if(a->ranges.begin(), a->ranges.end(), [](std::uint16_t r) { return r != 0; });
  EXPECT_NEAR(static_cast<double>(returns), side * side, 2.0 * side);
}

TEST(FlashLidar, AnOccluderStandsInTheFrameWithTheSensorsNoiseAndTheOtherRaysKeepTheirBits) {
  const FlashLidar lidar(box(1.0F));
  FrameTruth covered = truth(30.0);
  covered.occluder = {OccluderShape::kMast, 1.0, 0.5, 0.2, 6.0};
  auto a = std::make_unique<gnc::RangeImage>(), b = std::make_unique<gnc::RangeImage>();
  lidar.expose(truth(30.0), {}, 4.0, 5, *a);
  lidar.expose(covered, {}, 4.0, 5, *b);
  int blocked = 0;
  double sum = 0, squares = 0;
  for (int i = 0; i < 128 * 128; ++i) {
    if (a->ranges[i] == b->ranges[i]) continue;
    const double error_m = b->ranges[i] * kCount_m - 6.0;  // 6.03 m at the corner of this field of view
    ASSERT_LT(std::abs(error_m), 5.5 * 0.16);
    ++blocked;
    sum += error_m;
    squares += error_m * error_m;
  }
  ASSERT_GT(blocked, 500);
  EXPECT_NEAR(sum / blocked, 0.01, 0.03);
  EXPECT_NEAR(std::sqrt(squares / blocked), 0.16, 0.02);  // 0.1 m + 1 % of 6 m
}

TEST(FlashLidar, NamesTheTriangleThatARayMeets) {
  const RangeGrid grid = FlashLidar(square(1.0)).true_surfaces(truth(30.0), 64, 3.0);
  int returns = 0;
  for (int i = 0; i < 64 * 64; ++i) {
    const double right = grid.slope(i % 64), up = -grid.slope(i / 64);
    if (!std::isfinite(grid.range_m[i]) || std::abs(right - up) < 1e-6) continue;
    EXPECT_EQ(grid.surfaces[i].triangle, right > up ? 0U : 1U) << i;
    ++returns;
  }
  EXPECT_GT(returns, 1000);
}

TEST(FlashLidar, ATargetOffTheBoresightAppearsWhereItIs) {
  const FlashLidar lidar(square(1.0));
  const double swath = 6.0;
  const auto centroid = [&](const Eigen::Vector2d& offset_swaths) {
    FrameTruth moved = truth(30.0);
    moved.offset_swaths = offset_swaths;
    const RangeGrid grid = lidar.true_ranges(moved, 128, swath);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int returns = 0;
    for (int i = 0; i < 128 * 128; ++i) {
      if (!std::isfinite(grid.range_m[i])) continue;
      sum += grid.range_m[i] * Eigen::Vector3d(grid.slope(i % 128), 1.0, -grid.slope(i / 128)).normalized();
      ++returns;
    }
    EXPECT_GT(returns, 1000);
    return Eigen::Vector3d(sum / returns);
  };
  EXPECT_LT((centroid({0.0, 0.0}) - Eigen::Vector3d(0, 30, 0)).norm(), 0.03);
  for (const Eigen::Vector2d& offset :
       {Eigen::Vector2d(0.2, 0.0), Eigen::Vector2d(0.0, 0.2), Eigen::Vector2d(-0.12, 0.15)}) {
    const Eigen::Vector3d expected(offset.x() * swath, 30.0, offset.y() * swath);
    EXPECT_LT((centroid(offset) - expected).norm(), 0.03) << offset.transpose();
  }
}

TEST(FlashLidar, OutliersAreOnePercentOfTheReturnsBeyondFiveSigmaAndTheOthersDoNotChange) {
  const FlashLidar lidar(square(20.0));
  auto frame = std::make_unique<gnc::RangeImage>();
  auto exact = std::make_unique<gnc::RangeImage>();
  SensorSettings settings = sensor_settings(Condition::kOutliers);
  EXPECT_EQ(settings.rays, 128);
  EXPECT_EQ(settings.dropout_share, 0.0);
  for (const double range_m : {40.0, 100.0}) {
    SensorSettings quiet;
    quiet.noise = false;
    lidar.expose(truth(range_m), quiet, 3.0, 1, *exact);
    const double sigma_m = 0.1 + 0.01 * range_m;
    int outliers = 0, nearer = 0, others = 0;
    double sum = 0, squares = 0, fourth = 0, largest_m = 0;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      lidar.expose(truth(range_m), settings, 3.0, seed, *frame);
      for (int i = 0; i < 128 * 128; ++i) {
        ASSERT_NE(frame->ranges[i], 0);
        const double error_m = (frame->ranges[i] - exact->ranges[i]) * kCount_m;
        const double z = error_m / sigma_m;
        if (std::abs(z) > 4.99) {
          ++outliers;
          nearer += error_m < 0.0 ? 1 : 0;
          largest_m = std::max(largest_m, std::abs(error_m));
          continue;
        }
        ++others;
        sum += z;
        squares += z * z;
        fourth += z * z * z * z;
      }
    }
    // Bounds at four standard deviations of the counts and moments of 131,072 rays.
    EXPECT_NEAR(outliers / (8.0 * 128 * 128), 0.01, 0.0011) << range_m;
    EXPECT_NEAR(nearer / double(outliers), 0.5, 0.06) << range_m;
    EXPECT_LE(largest_m, 20.0 + kCount_m);
    EXPECT_GT(largest_m, 19.5);
    EXPECT_NEAR(sum / others, 0.0, 0.012);
    EXPECT_NEAR(squares / others, 1.0, 0.017);
    EXPECT_NEAR(fourth / others, 3.0, 0.12);
  }
}

TEST(FlashLidar, TheFieldOfViewHoldsTheWholeTargetAndStaysWithinTheSensorsLimits) {
  const TriangleMesh mesh = box(1.5F);
  for (const double range_m : {20.0, 100.0}) {
    const double half_rad = 0.5e-6 * fov_urad(swath_m(mesh), range_m);
    EXPECT_GT(half_rad, std::asin(mesh.radius_m() / range_m));
  }
  EXPECT_EQ(fov_urad(0.001, 100.0), gnc::kMinFov_urad);
  EXPECT_EQ(fov_urad(1000.0, 20.0), gnc::kMaxFov_urad);
}

// Two plates side by side, the right one `step_m` farther away. The plane between them contains the
// boresight.
std::unique_ptr<gnc::RangeImage> exposed_step(float step_m, double footprint_rays) {
  TriangleMesh mesh = {
      "step", {{-9, 0, -9}, {0, 0, -9}, {0, 0, 9}, {-9, 0, 9}}, {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}};
  for (const Eigen::Vector3f& v : {Eigen::Vector3f(0, step_m, -9), Eigen::Vector3f(9, step_m, -9),
                                   Eigen::Vector3f(9, step_m, 9), Eigen::Vector3f(0, step_m, 9)}) {
    mesh.vertices_trf_m.push_back(v);
  }
  SensorSettings settings;
  settings.noise = false;
  settings.footprint_rays = footprint_rays;
  auto frame = std::make_unique<gnc::RangeImage>();
  FlashLidar(mesh).expose(truth(50.0), settings, 1.0, 1, *frame);
  return frame;
}

// Verifies TS-SIL-300. Of the three casts across a footprint of three rays, none, one, two or three meet the
// farther plate.
TEST(FlashLidar, AFootprintMixesTheRangesOfTwoSurfaces) {
  const auto mixed = exposed_step(0.9F, 3.0);
  const int row = 64 * 128;
  EXPECT_NEAR(mixed->ranges[row + 62] * kCount_m, 50.0, 0.005);
  EXPECT_NEAR(mixed->ranges[row + 63] * kCount_m, 50.3, 0.005);
  EXPECT_NEAR(mixed->ranges[row + 64] * kCount_m, 50.6, 0.005);
  EXPECT_NEAR(mixed->ranges[row + 65] * kCount_m, 50.9, 0.005);
  const auto sharp = exposed_step(0.9F, 0.0);
  EXPECT_NEAR(sharp->ranges[row + 63] * kCount_m, 50.0, 0.005);
  EXPECT_NEAR(sharp->ranges[row + 64] * kCount_m, 50.9, 0.005);
  // Farther apart than the pulse is long: the first return.
  const auto apart = exposed_step(4.0F, 3.0);
  EXPECT_NEAR(apart->ranges[row + 63] * kCount_m, 50.0, 0.005);
  EXPECT_NEAR(apart->ranges[row + 64] * kCount_m, 50.0, 0.005);
  EXPECT_NEAR(apart->ranges[row + 65] * kCount_m, 54.0, 0.005);
}

// Verifies TS-SIL-300. A square whose edge runs between two rays keeps its rays; where its corner or less
// than half of the footprint meets it, the return is lost.
TEST(FlashLidar, AFootprintThatMeetsTooLittleIsLost) {
  SensorSettings settings;
  settings.noise = false;
  settings.footprint_rays = 3.0;
  auto frame = std::make_unique<gnc::RangeImage>();
  // A swath of 1.28 m: rays 1 cm apart at the square, which covers 60 x 60 of them.
  FlashLidar(square(0.3)).expose(truth(50.0), settings, 1.28, 1, *frame);
  const auto has_return = [&](int row, int column) { return frame->ranges[row * 128 + column] != 0; };
  EXPECT_TRUE(has_return(64, 64));
  EXPECT_TRUE(has_return(64, 34));   // six of nine casts meet the square
  EXPECT_FALSE(has_return(64, 33));  // three of nine
  EXPECT_FALSE(has_return(34, 34));  // four of nine
  EXPECT_TRUE(has_return(35, 34));
}

// Verifies TS-SIL-300.
TEST(FlashLidar, RowsOneAfterTheOtherSeeTheTargetAsItTurns) {
  const FlashLidar lidar(box(1.0F));
  SensorSettings settings;
  settings.noise = false;
  settings.scan_time_s = 0.5;
  FrameTruth turning = truth(30.0, Eigen::Quaterniond(0.9, 0.1, 0.3, -0.2).normalized());
  turning.rate_lrf_rad_s = {0.2, -0.1, 0.25};
  auto scanned = std::make_unique<gnc::RangeImage>();
  auto flash = std::make_unique<gnc::RangeImage>();
  lidar.expose(turning, settings, 4.0, 1, *scanned);
  settings.scan_time_s = 0.0;
  for (const int row : {40, 63, 64, 90}) {
    FrameTruth then = turning;
    const double later_s = 0.5 * ((row + 0.5) / 128.0 - 0.5);
    const double angle_rad = turning.rate_lrf_rad_s.norm() * later_s;
    then.q_lrf_trf = Eigen::AngleAxisd(angle_rad, turning.rate_lrf_rad_s.normalized()) * turning.q_lrf_trf;
    lidar.expose(then, settings, 4.0, 1, *flash);
    int returns = 0;
    for (int i = row * 128; i < (row + 1) * 128; ++i) {
      EXPECT_NEAR(scanned->ranges[i], flash->ranges[i], 1.0) << row << ' ' << i;
      returns += flash->ranges[i] != 0;
    }
    EXPECT_GT(returns, 20) << row;
  }
}

}  // namespace
}  // namespace tumblesight::sim
