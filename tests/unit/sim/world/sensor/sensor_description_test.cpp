// Verifies TS-SIL-320. Descriptions of sensors, and the frames that they make.
#include "sim/world/sensor/sensor_description.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "sim/world/frame_renderer.hpp"
#include "sim/world/math/angles.hpp"
#include "sim/world/sensor/ray_effects.hpp"
#include "sim/world/target/shipped_meshes.hpp"
#include "tests/support/hostile_files.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kCount_m = 1.0 / 128.0;
constexpr double kSwath_m = 6.0;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("no " + from);
  return text.replace(at, from.size(), to);
}

std::string refusal(const std::string& text) {
  try {
    (void)sensor_from_json(text, "my.json");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

SensorDescription flash_256() {
  return sensor_named("flash_256");
}

// A frame of NEAR at this range, without noise.
std::unique_ptr<gnc::RangeImage> frame_of(SensorSettings settings, double range_m, bool noise = false) {
  static const TriangleMesh mesh = make_near_shoemaker();
  static const FlashLidar lidar(mesh);
  settings.noise = noise;
  auto frame = std::make_unique<gnc::RangeImage>();
  lidar.expose({Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), Eigen::Vector3d::Zero(), range_m}, settings,
               kSwath_m, 3, *frame);
  return frame;
}

int returns_of(const gnc::RangeImage& frame) {
  return static_cast<int>(frame.ranges.size() -
                          std::count(frame.ranges.begin(), frame.ranges.end(), std::uint16_t{0}));
}

// Square metres that the returns cover across the boresight.
double area_m2(const gnc::RangeImage& frame, double range_m) {
  const double pitch_m = 2.0 * range_m * std::tan(0.5e-6 * frame.fov_urad) / frame.rays;
  return returns_of(frame) * pitch_m * pitch_m;
}

TEST(SensorDescription, OfThePaperIsTheDefault) {
  const SensorDescription paper = sensor_named("paper");
  EXPECT_EQ(to_json(paper), to_json(SensorDescription{}));
  EXPECT_EQ(crc32_of(sensor_from_json(to_json(SensorDescription{}), "default")), crc32_of(paper));
  EXPECT_TRUE(paper.is_the_papers());
  for (const std::string& name : sensor_names()) {
    const SensorDescription sensor = sensor_named(name);
    EXPECT_EQ(sensor.name, name);
    EXPECT_EQ(sensor.is_the_papers(), name == "paper") << name;
    EXPECT_NE(sensor_explanations().find(sensor.source), std::string::npos) << name;
  }
}

TEST(SensorDescription, IsReadBackAsItIsWritten) {
  for (const std::string& name : sensor_names()) {
    const SensorDescription sensor = sensor_named(name);
    const SensorDescription again = sensor_from_json(to_json(sensor), "again");
    EXPECT_EQ(to_json(again), to_json(sensor));
    EXPECT_EQ(to_string(again), to_string(sensor));
  }
}

// What a reader of the file may get wrong: the message names file, field, value and limits.
TEST(SensorDescription, RefusesWhatIsNotAsItMustBe) {
  const std::string good = to_json(flash_256());
  EXPECT_EQ(refusal(good), "accepted");
  const struct {
    const char* from;
    const char* to;
    const char* message;
  } kWrong[] = {
      {"\"rays_per_side\": 256", "\"rays_per_side\": 257",
       "sensor description my.json: field 'rays_per_side' is 257; it must be a whole number from 16 to 256"},
      {"\"rays_per_side\": 256", "\"rays_per_side\": 64.5", "a whole number from 16 to 256"},
      {"\"rays_per_side\": 256", "\"rays_per_side\": \"256\"", "a whole number from 16 to 256"},
      {"\"rays_per_side\"", "\"rays\"", "field 'rays' is unknown; the description has name, source, rays_"},
      {"\"scan_time_s\": 0.0,", "", "field 'scan_time_s' is missing; the description has name, "},
      {"\"scan_time_s\": 0.0,", "\"scan_time_s\": 0.0, \"scan_time_s\": 1.0,",
       "\"scan_time_s\" is given twice"},
      {"\"deg\": 20.0", "\"deg\": 41", "field 'fov.deg' is 41; it must be a number from 1 to 40"},
      {"\"deg\": 20.0", "\"degrees\": 20", "field 'fov.degrees' is unknown; field 'fov' has kind, deg"},
      {"\"fixed\"", "\"wide\"", "field 'fov.deg' is unknown; field 'fov' has kind"},
      {"\"tangent\"", "\"linear\"", "field 'spacing' is \"linear\"; it must be \"tangent\" or \"angle\""},
      {"\"constant_m\": 0.05", "\"constant_m\": null",
       "'noise.constant_m' is null; it must be a number from 0 "},
      {"\"name\": \"flash_256\"", "\"name\": \"Flash 256\"", "1 to 31 characters of a-z, 0-9 and _"},
      {"\"period_s\": 2.7", "\"period_s\": 0", "field 'period_s' is 0; it must be a number from 0.1 to 60"},
      {"\"link_budget\"", "\"threshold\"", "field 'detection.photoelectrons_at_100_m' is unknown"},
      {"\"constant_m\": 0.05", "\"constant_m\": 0.05, \"constant_m\": 0.06", "\"constant_m\" is given twice"},
      {"\"scan_time_s\": 0.0", "\"scan_time_s\": 1.5", "accepted"},
      {"\"scan_time_s\": 0.0,\n  \"period_s\": 2.7", "\"scan_time_s\": 1.5, \"period_s\": 1",
       "field 'scan_time_s' is 1.5; it must be at most period_s, 1"},
      {"\"constant_m\": 0.05", "\"constant_m\": 1e999", "a number is too large: "},
      {"{", "", "my.json: not JSON in line "},
      {"0.05", "0.05.1", "not JSON in line "},
  };
  for (const auto& wrong : kWrong) {
    const std::string message = refusal(replaced(good, wrong.from, wrong.to));
    EXPECT_NE(message.find(wrong.message), std::string::npos) << message;
  }
  const std::string deep(100'000, '[');
  EXPECT_NE(refusal(replaced(good, "500.0", deep)).find("nested more than 4 deep"), std::string::npos);
  EXPECT_NE(refusal(deep).find("nested more than 4 deep"), std::string::npos);
  for (const std::string& part :
       {std::string(10'000, '1'), "\"" + std::string(10'000, 'x') + "\"", std::string(10'000, 'x')})
    EXPECT_LT(refusal(replaced(good, "500.0", part)).size(), 300U);
  for (const char* const empty : {"", " \n"})
    EXPECT_EQ(refusal(empty), "sensor description my.json: the file is empty");
  const std::string gate = replaced(good, "500.0", "0.5");
  EXPECT_NE(refusal(gate).find("'range_gate_m' is [1.0,0.5]; it must be two ascending numbers from 0 to 500"),
            std::string::npos)
      << refusal(gate);
  EXPECT_NE(refusal("[]").find("the description must be an object with name, "), std::string::npos);
}

TEST(SensorDescription, ThatIsMissingIsRefusedWithTheNamesOfThoseThatShip) {
  try {
    (void)sensor_named("/no/such.json");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "'/no/such.json' is neither a file nor a sensor that ships; those are: paper, flash_256, "
                 "scan_128");
  }
}

TEST(SensorDescription, IsTheSensorOnWhichConditionsAndEffectsAct) {
  const SensorSettings base = flash_256().settings;
  const SensorSettings degraded = sensor_settings(Condition::kDegraded, {}, base);
  EXPECT_EQ(degraded.rays, 200) << "as 100 are of 128";
  EXPECT_EQ(degraded.dropout_share, 0.1);
  EXPECT_EQ(degraded.effects.link_budget, base.photoelectrons);
  const Effects effects = effects_from({"link_budget=3", "rays=64", "footprint=2"});
  const SensorSettings changed = sensor_settings(Condition::kNominal, effects, base);
  EXPECT_EQ(changed.effects.link_budget, 3.0);
  EXPECT_EQ(changed.rays, 64);
  EXPECT_EQ(changed.footprint_rays, 2.0);
  EXPECT_EQ(changed.noise_constant_m, base.noise_constant_m);
  SensorSettings few;
  few.rays = 16;
  EXPECT_EQ(sensor_settings(Condition::kDegraded, {}, few).rays, 16) << "a frame has no fewer";
}

// 256 rays over 20 degrees: at 20 m the target needs more than the middle 128 and is binned, from 40 m on the
// middle is cut out.
TEST(SensorDescription, WithMoreRaysThanAFrameIsBinnedNearAndWindowedFar) {
  SensorSettings settings = flash_256().settings;
  settings.photoelectrons = 0.0;
  settings.footprint_rays = 0.0;
  const auto near = frame_of(settings, 17.0);
  const auto far = frame_of(settings, 60.0);
  EXPECT_EQ(near->rays, 128);
  EXPECT_EQ(far->rays, 128);
  EXPECT_GT(near->fov_urad, 300'000U);
  EXPECT_NEAR(far->fov_urad, 2e6 * std::atan(0.5 * std::tan(10.0 * kRadPerDeg)), 1.0);
  SensorSettings paper;
  const double expected_m2 = area_m2(*frame_of(paper, 60.0), 60.0);
  EXPECT_NEAR(area_m2(*far, 60.0), expected_m2, 0.05 * expected_m2);
  EXPECT_GT(area_m2(*near, 17.0), expected_m2) << "a bin shows what any of its rays meets";
  EXPECT_LT(area_m2(*near, 17.0), 1.4 * expected_m2);
}

// A return beside the target keeps the window from cutting it off.
TEST(SensorDescription, AWindowHoldsEveryReturnAndIsWideEnoughForAFrame) {
  SensorSettings settings;
  settings.rays = 256;
  std::vector<double> ranges_m(256 * 256, kNoReturn_m);
  ranges_m[256 * 128 + 128] = 50.0;
  ranges_m[256 * 128 + 20] = 30.0;
  auto frame = std::make_unique<gnc::RangeImage>();
  report_ranges(ranges_m, settings, 400'000, *frame);
  EXPECT_EQ(returns_of(*frame), 2);
  EXPECT_NEAR(frame->fov_urad, 2e6 * std::atan(std::tan(0.2) * 216.0 / 256.0), 1.0);
  report_ranges(ranges_m, settings, gnc::kMinFov_urad, *frame);
  EXPECT_EQ(frame->fov_urad, gnc::kMinFov_urad);
  std::fill(ranges_m.begin(), ranges_m.end(), kNoReturn_m);
  report_ranges(ranges_m, settings, 400'000, *frame);
  EXPECT_EQ(frame->rays, 128);
  EXPECT_EQ(returns_of(*frame), 0);
}

TEST(SensorDescription, UniformInAngleGivesTheSameTargetAsUniformInTheTangent) {
  SensorSettings settings;
  const auto tangent = frame_of(settings, 20.0);
  settings.spacing = RaySpacing::kAngle;
  const auto angle = frame_of(settings, 20.0);
  EXPECT_EQ(angle->rays, tangent->rays);
  EXPECT_EQ(angle->fov_urad, tangent->fov_urad);
  int same = 0;
  for (std::size_t i = 0; i < tangent->ranges.size(); ++i) {
    same += std::abs(tangent->ranges[i] - angle->ranges[i]) < 0.1 / kCount_m;
  }
  EXPECT_GT(same, 0.95 * 128 * 128);
  EXPECT_NE(angle->ranges, tangent->ranges);
}

TEST(SensorDescription, GateAndFieldOfViewAreThoseOfTheDescription) {
  SensorSettings settings;
  settings.fov_deg = 12.0;
  EXPECT_NEAR(frame_of(settings, 50.0)->fov_urad, 1e6 * kRadPerDeg * 12.0, 1.0);
  EXPECT_EQ(frame_of(settings, 50.0)->fov_urad, frame_of(settings, 80.0)->fov_urad);
  settings.nearest_m = 60.0;
  EXPECT_EQ(returns_of(*frame_of(settings, 50.0)), 0);
  EXPECT_GT(returns_of(*frame_of(settings, 80.0)), 100);
  settings.farthest_m = 70.0;
  EXPECT_EQ(returns_of(*frame_of(settings, 80.0)), 0);
}

TEST(SensorDescription, NoiseIsThatOfTheDescription) {
  SensorSettings settings;
  settings.noise_constant_m = 0.02;
  settings.noise_per_range = 0.001;
  EXPECT_DOUBLE_EQ(range_sigma_m(80.0, settings), 0.1);
  const auto exact = frame_of(settings, 80.0);
  const auto noisy = frame_of(settings, 80.0, true);
  double squares = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < exact->ranges.size(); ++i) {
    if (exact->ranges[i] == 0) continue;
    const double error_m = (noisy->ranges[i] - exact->ranges[i]) * kCount_m;
    squares += error_m * error_m;
    ++count;
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.1, 6.0 * 0.1 / std::sqrt(2.0 * count));
}

TEST(SensorDescription, ATargetFillsTheViewWhereItsSwathDoes) {
  SensorSettings settings;
  EXPECT_NEAR(filling_range_m(settings, 42.0), 57.7, 0.1) << "40 m across";
  settings.fov_deg = 20.0;
  const double range_m = filling_range_m(settings, kSwath_m);
  EXPECT_NEAR(2.0 * range_m * std::tan(10.0 * kRadPerDeg), kSwath_m, 1e-9);
}

TEST(SensorDescription, IsRefusedUnreadIfItIsNoFileOrTooLarge) {
  expect_all_refused(".json", [](const std::string& path) { (void)sensor_named(path); });
}

}  // namespace
}  // namespace tumblesight::sim
