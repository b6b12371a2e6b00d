// Verifies TS-SIL-300. How surfaces return light, against closed forms on tilted plates.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "sim/world/math/angles.hpp"
#include "sim/world/scenario/condition.hpp"
#include "sim/world/sensor/effect_functions.hpp"
#include "sim/world/sensor/flash_lidar.hpp"
#include "sim/world/target/primitives.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kRange_m = 50.0;

// A plate that fills the view, its normal `tilt_deg` from the boresight.
TriangleMesh plate(double tilt_deg, bool is_panel = false) {
  const TriangleMesh flat = cap({{-40, 0, -40}, {40, 0, -40}, {40, 0, 40}, {-40, 0, 40}});
  const Eigen::Isometry3f tilt(
      Eigen::AngleAxisf(static_cast<float>(kRadPerDeg * tilt_deg), Eigen::Vector3f::UnitX()));
  const TriangleMesh tilted = placed(flat, tilt);
  return is_panel ? as_panel(tilted) : tilted;
}

std::unique_ptr<gnc::RangeImage> exposed(const TriangleMesh& mesh, const char* effect,
                                         double range_m = kRange_m, std::uint64_t noise_seed = 1) {
  SensorSettings settings = sensor_settings(Condition::kNominal, effects_from({effect}));
  settings.noise = false;
  auto frame = std::make_unique<gnc::RangeImage>();
  // A view of 1 degree: nearly the same incidence everywhere.
  FlashLidar(mesh).expose({Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), range_m}, settings, 0.1,
                          noise_seed, *frame);
  return frame;
}

double share_of_returns(const gnc::RangeImage& frame) {
  const auto count = std::count_if(frame.ranges.begin(), frame.ranges.end(), [](auto r) { return r != 0; });
  return static_cast<double>(count) / static_cast<double>(frame.ranges.size());
}

// Six standard deviations, and the change of the incidence over the view.
double tolerance(double share) {
  return 6.0 * std::sqrt(share * (1.0 - share) / (128.0 * 128.0)) + 1e-3;
}

TEST(SurfaceEffects, LobeReturnsLightUpToItsAngle) {
  EXPECT_EQ(share_of_returns(*exposed(plate(38.5), "lobe=40")), 1.0);
  EXPECT_EQ(share_of_returns(*exposed(plate(-38.5), "lobe=40")), 1.0);
  EXPECT_EQ(share_of_returns(*exposed(plate(41.5), "lobe=40")), 0.0);
  // At the angle itself the edge runs through the middle of the view.
  EXPECT_NEAR(share_of_returns(*exposed(plate(40.0), "lobe=40")), 0.5, 0.02);
}

TEST(SurfaceEffects, PanelLobeActsOnPanelsAlone) {
  EXPECT_EQ(share_of_returns(*exposed(plate(41.5, true), "panel_lobe=40")), 0.0);
  EXPECT_EQ(share_of_returns(*exposed(plate(38.5, true), "panel_lobe=40")), 1.0);
  EXPECT_EQ(share_of_returns(*exposed(plate(41.5), "panel_lobe=40")), 1.0);
}

TEST(SurfaceEffects, CosineIsTheProbabilityOfDetection) {
  for (const double tilt_deg : {0.0, 30.0, 60.0, 75.0}) {
    const double cosine = std::cos(kRadPerDeg * tilt_deg);
    const double share = share_of_returns(*exposed(plate(tilt_deg), "cosine=3"));
    EXPECT_NEAR(share, std::pow(cosine, 3.0), tolerance(std::pow(cosine, 3.0))) << tilt_deg;
    EXPECT_NEAR(share_of_returns(*exposed(plate(tilt_deg), "cosine=1")), cosine, tolerance(cosine));
  }
}

TEST(SurfaceEffects, LinkBudgetDetectsPhotonsOfALambertianSurface) {
  for (const double tilt_deg : {0.0, 60.0}) {
    for (const double range_m : {25.0, 100.0, 400.0}) {
      const double mean = 2.0 * std::cos(kRadPerDeg * tilt_deg) * std::pow(100.0 / range_m, 2.0);
      const double share = share_of_returns(*exposed(plate(tilt_deg), "link_budget=2", range_m));
      EXPECT_NEAR(share, 1.0 - std::exp(-mean), tolerance(1.0 - std::exp(-mean)))
          << tilt_deg << ' ' << range_m;
    }
  }
}

TEST(SurfaceEffects, LossesAreNewInEveryFrame) {
  EXPECT_NE(exposed(plate(45.0), "cosine=3", kRange_m, 1)->ranges,
            exposed(plate(45.0), "cosine=3", kRange_m, 2)->ranges);
}

// A box of 2 m seen along +y from 50 m in a view of 4 m: the reflectors at the corners of its near face bloom
// over discs.
TEST(SurfaceEffects, RetroreflectorsBloomOverTheirRadius) {
  TriangleMesh body = box({2.0F, 2.0F, 2.0F});
  // A tip towards the sensor, the only vertex at -y.
  append(body, cap({{0.0F, -1.5F, 0.0F}, {0.2F, -1.0F, 0.2F}, {-0.2F, -1.0F, 0.2F}}));
  SensorSettings settings;
  settings.noise = false;
  const FrameTruth truth{Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), kRange_m};
  const FlashLidar lidar(body);
  auto plain = std::make_unique<gnc::RangeImage>();
  auto bloomed = std::make_unique<gnc::RangeImage>();
  lidar.expose(truth, settings, 4.0, 1, *plain);
  settings.effects.retroreflectors = 5.0;
  lidar.expose(truth, settings, 4.0, 1, *bloomed);
  const auto tip_counts = static_cast<std::uint16_t>(std::lround(48.5 * 128.0));
  const auto at_tip = std::count(bloomed->ranges.begin(), bloomed->ranges.end(), tip_counts);
  EXPECT_NEAR(static_cast<double>(at_tip), kPi * 25.0, 6.0);
  int changed = 0;
  for (std::size_t i = 0; i < plain->ranges.size(); ++i) changed += plain->ranges[i] != bloomed->ranges[i];
  EXPECT_GE(changed, at_tip - 10);
}

TEST(SurfaceEffects, RetroreflectorsAreNotOnMissingParts) {
  TriangleMesh body = box({2.0F, 2.0F, 2.0F});
  body.vertices_trf_m.emplace_back(0.0F, -1.5F, 0.0F);  // of a part whose triangles are gone
  SensorSettings settings;
  settings.noise = false;
  settings.effects.retroreflectors = 5.0;
  const FrameTruth truth{Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), kRange_m};
  auto frame = std::make_unique<gnc::RangeImage>();
  FlashLidar(body).expose(truth, settings, 4.0, 1, *frame);
  const auto part_counts = static_cast<std::uint16_t>(std::lround(48.5 * 128.0));
  EXPECT_EQ(std::count(frame->ranges.begin(), frame->ranges.end(), part_counts), 0);
}

// A double pyramid with a corner at each end of the three axes, all faces 55 degrees from the boresight: each
// of the effects takes nearly all of its returns away, and what is seen are the reflectors. The one on the
// far side is hidden behind the faces.
TEST(SurfaceEffects, SurfaceThatReturnsNoLightHidesTheRetroreflectorBehindIt) {
  TriangleMesh body;
  body.vertices_trf_m = {{1, 0, 0}, {-1, 0, 0}, {0.4F, 1, 0.4F}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const std::uint32_t x : {0U, 1U})
    for (const std::uint32_t y : {2U, 3U})
      for (const std::uint32_t z : {4U, 5U}) body.triangles.push_back({x, y, z});
  body = as_panel(body);
  const auto counts_at = [](const gnc::RangeImage& frame, const Eigen::Vector3d& place_m) {
    const auto counts = static_cast<std::uint16_t>(std::lround(place_m.norm() * 128.0));
    return static_cast<double>(std::count(frame.ranges.begin(), frame.ranges.end(), counts));
  };
  for (const char* effect : {"lobe=40", "panel_lobe=40", "cosine=20", "link_budget=0.01"}) {
    SensorSettings settings =
        sensor_settings(Condition::kNominal, effects_from({effect, "retroreflectors=5"}));
    settings.noise = false;
    FrameTruth truth{Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), kRange_m};
    auto frame = std::make_unique<gnc::RangeImage>();
    FlashLidar(body).expose(truth, settings, 4.0, 1, *frame);
    EXPECT_NEAR(counts_at(*frame, {0.0, kRange_m - 1.0, 0.0}), kPi * 25.0, 6.0) << effect;
    EXPECT_LE(counts_at(*frame, {0.4, kRange_m + 1.0, 0.4}), 3.0) << effect << ": behind a face";
    EXPECT_NEAR(share_of_returns(*frame), 5.0 * kPi * 25.0 / (128.0 * 128.0), 0.01) << effect;
    truth.q_lrf_trf = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitZ());
    FlashLidar(body).expose(truth, settings, 4.0, 1, *frame);
    EXPECT_NEAR(counts_at(*frame, {-0.4, kRange_m - 1.0, 0.4}), kPi * 25.0, 6.0) << effect << ": in front";
  }
}

// A bar of a third of a ray's width, in the middle of a column of rays, gives none of them enough light.
TEST(SurfaceEffects, BarThatIsLostInTheFootprintHidesTheRetroreflectorBehindIt) {
  constexpr float kMiddle_m = 4.0F / 128.0F / 2.0F;
  for (const bool covered : {true, false}) {
    const float left_m = covered ? kMiddle_m - 0.006F : 0.5F;
    TriangleMesh body =
        cap({{left_m, -1, -1}, {left_m + 0.012F, -1, -1}, {left_m + 0.012F, -1, 1}, {left_m, -1, 1}});
    append(body, cap({{kMiddle_m, 1, kMiddle_m}, {kMiddle_m, 0.9F, 0}, {kMiddle_m + 0.01F, 0.9F, 0}}));
    SensorSettings settings =
        sensor_settings(Condition::kNominal, effects_from({"footprint=1", "retroreflectors=5"}));
    settings.noise = false;
    const FrameTruth truth{Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), kRange_m};
    auto frame = std::make_unique<gnc::RangeImage>();
    FlashLidar(body).expose(truth, settings, 4.0, 1, *frame);
    const auto tip_counts = static_cast<std::uint16_t>(std::lround((kRange_m + 1.0) * 128.0));
    const auto at_tip = std::count(frame->ranges.begin(), frame->ranges.end(), tip_counts);
    EXPECT_NEAR(static_cast<double>(at_tip), covered ? 0.0 : kPi * 25.0, 6.0) << covered;
  }
}

}  // namespace
}  // namespace tumblesight::sim
