#include "gnc/registration/refinement.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/trials.hpp"
#include "tests/unit/gnc/registration/scene.hpp"

namespace tumblesight::gnc {
namespace {

constexpr Sensor kSensor{64, 20.0};
constexpr double kDepth_m = 15.0;
constexpr RangeNoise kPapersNoise{100, 1000};
constexpr RangeNoise kLittleNoise{30, 0};

class Refine : public testing::Test {
 protected:
  Refinement refined(const FrameView& view, const Pose& start, const RefinementSettings& settings = {}) {
    Refinement result;
    refine(section_.mesh(), view, start, settings, *scratch_, result);
    return result;
  }

  MeshSection section_{lopsided_body()};
  std::unique_ptr<RefinementScratch> new_scratch() {
    auto scratch = std::make_unique<RefinementScratch>();
    scratch->surface.vertices = vertices_.get();
    return scratch;
  }
  std::unique_ptr<ScreenVertices> vertices_ = std::make_unique<ScreenVertices>();
  std::unique_ptr<RefinementScratch> scratch_ = new_scratch();
};

double turn_deg(const ExactPose& a, const ExactPose& b) {
  return Eigen::AngleAxisd(Eigen::Quaterniond(a.r_lrf_trf.transpose() * b.r_lrf_trf).normalized()).angle() *
         180.0 / M_PI;
}

void expect_rotation(const Pose& pose) {
  const Eigen::Matrix3d r = exact(pose).r_lrf_trf;
  EXPECT_LT((r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_NEAR(r.determinant(), 1.0, 1e-5);
}

Eigen::Vector3d random_direction(Random& random) {
  return random.vector(1.0).normalized();
}

struct Scene {
  ExactPose truth;
  Pose start;  // 2 degrees and 5 cm away
  std::unique_ptr<FrameView> view;
};
Scene scene_of(bool is_noisy, Random& random) {
  const Body body = rounded(lopsided_body());
  Scene scene;
  scene.truth = {random.rotation(), Eigen::Vector3d(0.0, kDepth_m, 0.0) + random.vector(0.2)};
  const auto depths_m = cast(body, scene.truth, kSensor);
  Frame frame(kSensor);
  for (int i = 0; i < kSensor.rays * kSensor.rays; ++i) {
    const double depth_m = depths_m[static_cast<std::size_t>(i)];
    const int row = i / kSensor.rays, column = i % kSensor.rays;
    if (depth_m == kNothing || (is_noisy && random.happens(0.1))) continue;
    const double range_m = depth_m * ray(kSensor, row, column).norm();
    frame.add(row, column, range_m + (is_noisy ? (0.1 + 0.01 * range_m) * random.normal() : 0.0));
  }
  const Eigen::Vector3d turn_rad = 2.0 * M_PI / 180.0 * random_direction(random);
  const Eigen::Vector3d move_m = 0.05 * random_direction(random);
  scene.start = fixed(moved(scene.truth, turn_rad, move_m));
  scene.view = view_of(frame, 1e-6 * scene.start.origin_lrf_um[1], body.radius_m,
                       is_noisy ? kPapersNoise : kLittleNoise);
  return scene;
}

// Of many refinements.
class Errors {
 public:
  void add(const ExactPose& found, const ExactPose& truth) {
    const double turn = turn_deg(found, truth), move_m = (found.origin_m - truth.origin_m).norm();
    turn_squares_ += turn * turn;
    move_squares_ += move_m * move_m;
    largest_turn_deg_ = std::max(largest_turn_deg_, turn);
    largest_move_m_ = std::max(largest_move_m_, move_m);
    ++count_;
  }
  double turn_rms_deg() const { return std::sqrt(turn_squares_ / count_); }
  double move_rms_m() const { return std::sqrt(move_squares_ / count_); }
  double largest_turn_deg() const { return largest_turn_deg_; }
  double largest_move_m() const { return largest_move_m_; }

 private:
  double turn_squares_ = 0.0, move_squares_ = 0.0, largest_turn_deg_ = 0.0, largest_move_m_ = 0.0;
  int count_ = 0;
};

// What remains comes from the silhouette, which is known by whole rays of 8 cm.
TEST_F(Refine, RecoversThePoseWithoutNoise) {
  Random random(1);
  Errors errors;
  for (int i = 0; i < trials(40); ++i) {
    const Scene scene = scene_of(false, random);
    RefinementSettings settings;
    settings.steps = 6;
    const Refinement found = refined(*scene.view, scene.start, settings);
    expect_rotation(found.pose);
    EXPECT_GT(found.fill_q16, 65'000U);
    errors.add(exact(found.pose), scene.truth);
  }
  EXPECT_LT(errors.turn_rms_deg(), 0.15);
  EXPECT_LT(errors.largest_turn_deg(), 0.5);
  EXPECT_LT(errors.move_rms_m(), 0.008);
  EXPECT_LT(errors.largest_move_m(), 0.03);
}

TEST_F(Refine, RecoversThePoseWithThePapersNoiseAndATenthOfTheReturnsLost) {
  Random random(2);
  Errors errors;
  for (int i = 0; i < trials(40); ++i) {
    const Scene scene = scene_of(true, random);
    const Refinement found = refined(*scene.view, scene.start);
    expect_rotation(found.pose);
    EXPECT_NEAR(found.fill_q16, 0.9 * 65536, 0.06 * 65536);
    errors.add(exact(found.pose), scene.truth);
  }
  EXPECT_LT(errors.turn_rms_deg(), 1.4);
  EXPECT_LT(errors.largest_turn_deg(), 4.0);
  EXPECT_LT(errors.move_rms_m(), 0.025);
  EXPECT_LT(errors.largest_move_m(), 0.08);
}

TEST_F(Refine, SameFrameGivesTheSameBits) {
  Random random(3);
  const Scene scene = scene_of(true, random);
  const Refinement first = refined(*scene.view, scene.start);
  scratch_ = new_scratch();
  refined(*scene.view, fixed(moved(scene.truth, {0.3, 0.2, 0.1}, {0.1, 0.1, 0.1})));  // leaves its traces
  const Refinement again = refined(*scene.view, scene.start);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(again.pose.r_lrf_trf(i).raw(), first.pose.r_lrf_trf(i).raw());
  EXPECT_EQ(again.pose.origin_lrf_um, first.pose.origin_lrf_um);
  EXPECT_EQ(again.equations.information, first.equations.information);
  EXPECT_EQ(again.equations.gradient, first.equations.gradient);
  EXPECT_EQ(again.fill_q16, first.fill_q16);
}

TEST_F(Refine, TheNumberOfStepsIsLimited) {
  Random random(4);
  const Scene scene = scene_of(true, random);
  const auto position_after = [&](int steps) {
    RefinementSettings settings;
    settings.steps = steps;
    return refined(*scene.view, scene.start, settings).pose.origin_lrf_um;
  };
  EXPECT_EQ(position_after(0), position_after(1));
  EXPECT_EQ(position_after(1000), position_after(RefinementSettings::kMaxSteps));
  EXPECT_NE(position_after(1), position_after(2));
}

// The surface and the ranges are those of the pose that is returned, and not of the step before.
TEST_F(Refine, LeavesTheSurfaceAtThePose) {
  Random random(11);
  const Scene scene = scene_of(true, random);
  const Refinement found = refined(*scene.view, scene.start, RefinementSettings());
  const auto drawn = std::make_unique<RenderedSurface>();
  const auto vertices = std::make_unique<ScreenVertices>();
  drawn->vertices = vertices.get();
  WorkBudget budget;
  render(section_.mesh(), *scene.view, found.pose, *drawn, budget);
  EXPECT_EQ(scratch_->surface.filled.rows, drawn->filled.rows);
  RangeFit ranges;
  fit_ranges(*scene.view, found.pose, *drawn, ranges, budget);
  EXPECT_EQ(scratch_->ranges.squares_q8, ranges.squares_q8);
  EXPECT_GT(ranges.blocks, 0);
}

TEST_F(Refine, PoseStaysWithoutAReturnOrASurface) {
  const auto view = empty_view(kSensor, kDepth_m, lopsided_body().radius_m);
  show_all(kHidden, *view);
  const Pose start = fixed({Eigen::Matrix3d::Identity(), {0.0, kDepth_m, 0.0}});
  const Refinement hidden = refined(*view, start);
  EXPECT_EQ(hidden.pose.origin_lrf_um, start.origin_lrf_um);
  EXPECT_LT(turn_deg(exact(hidden.pose), exact(start)), 1e-4);
  Refinement found;
  refine(SurfaceMesh(), *view, start, RefinementSettings(), *scratch_, found);
  EXPECT_EQ(found.pose.origin_lrf_um, start.origin_lrf_um);
  EXPECT_LT(turn_deg(exact(found.pose), exact(start)), 1e-4);
}

// A tenth of a radian and of a radius per step.
TEST_F(Refine, StepsAreLimited) {
  Random random(5);
  RefinementSettings settings;
  settings.steps = 1;
  settings.turn_sigma_q24 = settings.move_sigma_q24 = 1 << 26;
  double largest_turn = 0.0, largest_move_m = 0.0;
  for (int i = 0; i < trials(100); ++i) {
    const auto view = view_of(Frame(kSensor), kDepth_m, lopsided_body().radius_m, {5, 0});
    std::vector<std::int16_t> rays(std::size_t{kSensor.rays} * kSensor.rays);
    for (std::int16_t& ray : rays) ray = static_cast<std::int16_t>(random.below(2000) + (i % 5 - 2) * 4000);
    show(rays, *view);
    const Pose start = fixed({random.rotation(), {0.0, kDepth_m, 0.0}});
    const Refinement found = refined(*view, start, settings);
    largest_turn = std::max(largest_turn, turn_deg(exact(found.pose), exact(start)) * M_PI / 180.0);
    largest_move_m =
        std::max(largest_move_m, (exact(found.pose).origin_m - exact(start).origin_m).cwiseAbs().maxCoeff());
  }
  EXPECT_GT(largest_turn, 0.02);
  EXPECT_LE(largest_turn, 0.1 + 1e-3);
  EXPECT_LE(largest_move_m, 0.1 * lopsided_body().radius_m + 1e-3);
}

// Sanitizers tell overflows.
TEST_F(Refine, EndsWithARotationWhateverTheFrame) {
  Random random(6);
  for (int i = 0; i < trials(120); ++i) {
    const Sensor sensor{i % 3 == 0 ? 16 : 64, i % 2 == 0 ? 40.0 : 3.0};
    const double radius_m = std::array{2.5, 0.5, 50.0}[static_cast<std::size_t>(i % 7 % 3)];
    const double depth_m = std::min(500.0, radius_m * std::exp(random.uniform(0.75, 4.0)));
    Frame frame(sensor);
    for (int row = 0; row < sensor.rays; ++row) {
      for (int column = 0; column < sensor.rays; ++column) {
        if (random.happens(0.1)) frame.hide(row, column, random.uniform(0.0, 511.0));
        if (random.happens(0.5)) frame.add(row, column, random.uniform(0.01, 511.0));
      }
    }
    const RangeNoise noise{static_cast<std::uint16_t>(i % 4 == 0 ? 0 : random.below(200)),
                           static_cast<std::uint16_t>(i % 4 == 0 ? 0 : random.below(1000))};
    const auto view = view_of(frame, depth_m, radius_m, noise);
    const double off_m = std::array{0.0, 1.0, 10.0, 2000.0}[static_cast<std::size_t>(i % 4)];
    const Pose start =
        fixed({random.rotation(), Eigen::Vector3d(0.0, depth_m, 0.0) + off_m * random_direction(random)});
    RefinementSettings settings;
    settings.steps = 1 + i % 8;
    SCOPED_TRACE(i);
    expect_rotation(refined(*view, start, settings).pose);
  }
}

}  // namespace
}  // namespace tumblesight::gnc
