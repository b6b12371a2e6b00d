#include "gnc/registration/range_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/trials.hpp"
#include "tests/unit/gnc/registration/scene.hpp"

namespace tumblesight::gnc {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr Sensor kSensor{32, 20.0};
constexpr double kDepth_m = 10.0;

class RangeFitOfAPlate : public testing::Test {
 protected:
  void use(const ExactPose& pose, const RangeNoise& noise = {}) {
    pose_ = fixed(pose);
    view_ = view_of(Frame(kSensor), kDepth_m, plate().radius_m, noise);
    render(section_.mesh(), *view_, pose_, *surface_, surface_->budget);
    rays_.assign(std::size_t{kSensor.rays} * kSensor.rays, kMissed);
    show(rays_, *view_);
  }
  // The four rays of a block, as they are rendered and so many counts nearer. False: not all are on the
  // plate.
  bool show_block(int row, int column, int counts) {
    for (int i = 0; i < 4; ++i) {
      const int at_row = row + i / 2, at_column = column + i % 2;
      if (!surface_->is_filled(at_row, at_column)) return false;
      rays_[static_cast<std::size_t>(at_row * kSensor.rays + at_column)] =
          static_cast<std::int16_t>(std::clamp(surface_->at(at_row, at_column) + counts, -32'766, 32'767));
    }
    show(rays_, *view_);
    return true;
  }
  RangeFit fit(int every = 1) const {
    RangeFit result;
    fit_ranges(*view_, pose_, *surface_, result, surface_->budget, every);
    return result;
  }
  // Inverse depth of the plate, moved, on a ray in standard deviations.
  double inverse_depth(const Eigen::Vector3d& turn, const Eigen::Vector3d& move_m, double row,
                       double column) const {
    const ExactPose at = moved(exact(pose_), turn, move_m);
    const Eigen::Vector3d normal = at.r_lrf_trf.col(1);
    const double depth_m = normal.dot(at.origin_m) / normal.dot(ray(kSensor, row, column));
    return inverse_depth_of(*view_, depth_m) * 256.0 / view_->noise_q8;
  }
  // Its change by each unknown, in the middle of a block.
  Vector6 expected_row(int row, int column) const {
    constexpr double kStep = 1e-5;
    Vector6 change;
    for (int i = 0; i < kUnknowns; ++i) {
      Eigen::Vector3d by = Eigen::Vector3d::Zero();
      by(i % 3) = kStep;
      const Eigen::Vector3d turn = i < 3 ? by : Eigen::Vector3d(0.0, 0.0, 0.0);
      const Eigen::Vector3d move_m = i < 3 ? Eigen::Vector3d(0.0, 0.0, 0.0) : plate().radius_m * by;
      change(i) = (inverse_depth(turn, move_m, row + 0.5, column + 0.5) -
                   inverse_depth(-turn, -move_m, row + 0.5, column + 0.5)) /
                  (2.0 * kStep);
    }
    return change;
  }

  MeshSection section_{plate()};
  Pose pose_;
  std::vector<std::int16_t> rays_;  // that view_ shows
  std::unique_ptr<FrameView> view_;
  std::unique_ptr<Rendering> surface_ = std::make_unique<Rendering>();
};

ExactPose facing() {
  return {Eigen::Matrix3d::Identity(), {0.0, kDepth_m, 0.0}};
}

// A block that is a third of a standard deviation nearer; its rows have an error by the slope of the rendered
// inverse depth, which is rounded to a count per ray.
TEST_F(RangeFitOfAPlate, RowIsTheDerivativeOfTheInverseDepth) {
  Random random(1);
  int blocks = 0;
  for (int i = 0; i < trials(300); ++i) {
    const Eigen::Vector3d turn_rad = {random.uniform(-1.0, 1.0), 0.0, random.uniform(-1.0, 1.0)};
    const Eigen::Vector3d move_m = random.vector(0.2);
    use(moved(facing(), turn_rad, move_m));
    const int row = 2 * random.below(kSensor.rays / 2), column = 2 * random.below(kSensor.rays / 2);
    const int counts = view_->noise_q8 / 768;
    if (!show_block(row, column, counts)) continue;
    const RangeFit found = fit();
    if (found.blocks == 0) continue;
    ++blocks;
    const Vector6 expected = 256.0 * expected_row(row, column);
    const double mean = counts * 256.0 / view_->noise_q8;
    const double weight = 4.0 * std::pow(1.0 + mean * mean / 6.25, -2.0);
    const double bound = 0.01 * expected.norm() + 256.0 * 2.0 * view_->rays_per_radius_q8 / view_->noise_q8;
    for (int k = 0; k < kUnknowns; ++k) {
      const auto at = static_cast<std::size_t>(k);
      // Weight in 1/4096, difference in 1/256.
      EXPECT_NEAR(static_cast<double>(found.equations.gradient[at]) / (4096.0 * weight * mean), expected(k),
                  bound)
          << i << ": " << k;
      for (int j = 0; j <= k; ++j)
        EXPECT_NEAR(static_cast<double>(found.equations.information[element(k, j)]) / weight,
                    expected(k) * expected(j), 2.0 * bound * expected.norm())
            << i << ": " << k << ' ' << j;
    }
    EXPECT_EQ(found.blocks, 1) << "one block";
    EXPECT_NEAR(static_cast<double>(found.squares_q8) / 256.0, 4.0 * mean * mean, 0.05);
  }
  EXPECT_GT(blocks, trials(300) / 10);
}

TEST_F(RangeFitOfAPlate, NothingPullsWhereTheSurfaceIs) {
  use(moved(facing(), {0.0, 0.0, 0.0}, {0.1, 0.0, -0.1}));  // where the means of the blocks are exact
  for (int row = 0; row < kSensor.rays; row += 2)
    for (int column = 0; column < kSensor.rays; column += 2) show_block(row, column, 0);
  const RangeFit found = fit();
  EXPECT_GT(found.blocks, 40);
  for (const std::int64_t number : found.equations.gradient) EXPECT_EQ(number, 0);
  EXPECT_EQ(found.squares_q8, 0);
  EXPECT_GT(found.equations.information[element(4, 4)], 0);
}

TEST_F(RangeFitOfAPlate, EverySecondBlockCountsTwice) {
  use(moved(facing(), {0.2, 0.0, -0.1}, {0.1, 0.0, -0.1}));
  for (int row = 0; row < kSensor.rays; row += 2)
    for (int column = 0; column < kSensor.rays; column += 2) show_block(row, column, 20);
  const RangeFit all = fit(), half = fit(2);
  ASSERT_GT(all.blocks, 40);
  EXPECT_NEAR(2 * half.blocks, all.blocks, 0.1 * all.blocks);
  for (int i = 0; i < kUnknowns; ++i) {
    const auto of = [i](const RangeFit& found) {
      return static_cast<double>(found.equations.information[element(i, i)]);
    };
    EXPECT_NEAR(of(half) / of(all), 1.0, 0.1) << i;
  }
  EXPECT_NEAR(
      static_cast<double>(half.equations.gradient[4]) / static_cast<double>(all.equations.gradient[4]), 1.0,
      0.1);
}

TEST_F(RangeFitOfAPlate, RaysThatAreMissedOrHiddenAddNothing) {
  use(facing());
  for (const std::int16_t nothing : {kMissed, kHidden}) {
    show_all(nothing, *view_);
    const RangeFit found = fit();
    EXPECT_EQ(found.blocks, 0);
    EXPECT_EQ(found.squares_q8, 0);
    EXPECT_EQ(found.equations.information, NormalEquations().information);
    EXPECT_EQ(found.equations.gradient, NormalEquations().gradient);
  }
}

// A plate at 85 degrees of incidence.
TEST_F(RangeFitOfAPlate, SurfaceThatIsTooSteepAddsNothing) {
  for (const double degrees : {60.0, 85.0}) {
    use(moved(facing(), {0.0, 0.0, degrees * M_PI / 180.0}, {0.0, 0.0, 0.0}));
    bool is_shown = false;
    for (int row = 0; row < kSensor.rays; row += 2)
      for (int column = 0; column < kSensor.rays; column += 2)
        is_shown = show_block(row, column, 0) || is_shown;
    EXPECT_TRUE(is_shown || degrees > 70.0);
    EXPECT_EQ(fit().blocks > 0, degrees < 70.0) << degrees;
  }
}

// x / (1 + (x / 2.5)^2)^2: the largest is 0.81, at 1.44 standard deviations.
TEST_F(RangeFitOfAPlate, PullOfADifferenceIsThatOfGemanAndMcClure) {
  use(facing(), {200, 0});
  const int row = 16, column = 16;
  const double change = 256.0 * expected_row(row, column)(4);
  for (const double x : {-8.0, -3.0, -1.0, -0.2, 0.2, 0.5, 1.0, 1.44, 2.0, 3.0, 5.0, 8.0}) {
    const int counts = static_cast<int>(std::lround(x * view_->noise_q8 / 256.0));
    ASSERT_TRUE(show_block(row, column, counts));
    const double mean = counts * 256.0 / view_->noise_q8;
    const RangeFit found = fit();
    const double pull = static_cast<double>(found.equations.gradient[4]) / (4.0 * 4096.0 * change);
    EXPECT_NEAR(pull, mean * std::pow(1.0 + mean * mean / 6.25, -2.0), 0.02) << x;
    EXPECT_NEAR(static_cast<double>(found.squares_q8) / 256.0, std::min(9.0, 4.0 * mean * mean), 0.1) << x;
  }
}

TEST_F(RangeFitOfAPlate, OutlierPullsLessThanASmallDifference) {
  for (const RangeNoise noise :
       {RangeNoise{100, 1000}, RangeNoise{20, 0}, RangeNoise{5, 0}, RangeNoise{1, 0}}) {
    SCOPED_TRACE(noise.constant_mm);
    use(facing(), noise);
    const auto pull = [&](int counts) {
      EXPECT_TRUE(show_block(16, 16, counts));
      return std::abs(static_cast<double>(fit().equations.gradient[4]));
    };
    const double largest = pull(std::max(1, static_cast<int>(view_->noise_q8) * 3 / 512));
    EXPECT_GT(largest, 0.0);
    for (int counts = view_->noise_q8 * 6 / 256; counts <= 32'766; counts = counts * 5 / 4 + 1) {
      EXPECT_LE(pull(counts), largest) << counts;
      EXPECT_LE(pull(-counts), largest) << -counts;
    }
  }
}

// The largest differences there are; sanitizers tell an overflow.
TEST_F(RangeFitOfAPlate, DifferencesOfASensorWithoutNoiseDoNotOverflow) {
  for (const RangeNoise noise : {RangeNoise{0, 0}, RangeNoise{1, 0}, RangeNoise{65'535, 65'535}}) {
    use(facing(), noise);
    for (const int counts : {-65'535, 65'535, -1000, 1000, -1, 1}) {
      for (int row = 0; row < kSensor.rays; row += 2)
        for (int column = 0; column < kSensor.rays; column += 2) show_block(row, column, counts);
      const RangeFit found = fit();
      EXPECT_GE(found.squares_q8, 0);
      EXPECT_LE(found.squares_q8, std::int64_t{9 * 256} * found.blocks);
      for (int k = 0; k < kUnknowns; ++k) EXPECT_GE(found.equations.information[element(k, k)], 0);
    }
  }
}

class FillShare : public RangeFitOfAPlate {
 protected:
  bool is_inside(int row, int column) const {
    return surface_->is_filled(row - 2, column) && surface_->is_filled(row + 2, column) &&
           surface_->is_filled(row, column - 2) && surface_->is_filled(row, column + 2);
  }
};

TEST_F(FillShare, IsTheShareOfReturnsInsideTheSilhouette) {
  Random random(2);
  for (const double share : {0.0, 0.3, 0.9, 1.0}) {
    use(moved(facing(), {0.2, 0.5, -0.2}, {0.1, 0.0, -0.1}));
    int inside = 0, returned = 0;
    for (int row = 0; row < kSensor.rays; ++row) {
      for (int column = 0; column < kSensor.rays; ++column) {
        // Near the silhouette and beyond it returns mean nothing.
        const bool is_hit = random.happens(is_inside(row, column) ? share : 0.5);
        const bool is_hidden = random.happens(0.2);
        rays_[static_cast<std::size_t>(row * kSensor.rays + column)] =
            is_hidden ? kHidden : (is_hit ? std::int16_t{0} : kMissed);
        if (!is_inside(row, column) || is_hidden) continue;
        ++inside;
        returned += is_hit ? 1 : 0;
      }
    }
    show(rays_, *view_);
    ASSERT_GT(inside, 20);
    EXPECT_NEAR(fill_share(*view_, *surface_), 65536.0 * returned / inside, 1.0) << share;
  }
}

TEST_F(FillShare, IsWholeWithoutRaysInside) {
  use({Eigen::Matrix3d::Identity(), {0.0, -kDepth_m, 0.0}});
  EXPECT_EQ(fill_share(*view_, *surface_), 65536U);
  use(facing());
  show_all(kHidden, *view_);
  EXPECT_EQ(fill_share(*view_, *surface_), 65536U);
}

}  // namespace
}  // namespace tumblesight::gnc
