// Verifies TS-SIL-300, TS-SIL-310, TS-SIL-340. The table of effects, and that a run without effects is what
// it was.
#include "sim/world/sensor/effects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <set>
#include <stdexcept>

#include "sim/world/frame_renderer.hpp"
#include "sim/world/sensor/occlusion.hpp"
#include "sim/world/sensor/ray_effects.hpp"
#include "sim/world/target/shipped_meshes.hpp"

namespace tumblesight::sim {
namespace {

std::string refusal(const std::vector<std::string>& texts) {
  try {
    (void)effect_ranges_from(texts);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Effects, HaveNamesRangesAndExplanationsOfTheirOwn) {
  std::set<std::string> names;
  for (const EffectRow& row : effect_table()) {
    names.insert(row.name);
    EXPECT_LE(row.lowest, row.highest) << row.name;
    EXPECT_LE(std::string(row.explanation).size(), 100U) << row.name;
    EXPECT_TRUE(holds(effect_explanations(), row.explanation)) << row.name;
    EXPECT_TRUE(holds(effect_explanations(), row.source)) << row.name;
    Effects effects;
    effects.*row.strength = row.highest;
    EXPECT_EQ(to_string(effects).substr(0, to_string(effects).find('=')), row.name);
    EXPECT_EQ(to_string(effects_from({to_string(effects)})), to_string(effects));
  }
  EXPECT_EQ(names.size(), effect_table().size());
  // No member without a row.
  EXPECT_EQ(sizeof(Effects), effect_table().size() * sizeof(double));
}

TEST(Effects, AreReadTogetherInAnyOrder) {
  const Effects effects = effects_from({"noise=5", "panel_turn=-10"});
  EXPECT_EQ(effects.noise, 5.0);
  EXPECT_EQ(effects.panel_turn, -10.0);
  EXPECT_EQ(to_string(effects), "panel_turn=-10,noise=5");
  EXPECT_EQ(to_string(effects_from({})), "");
}

TEST(Effects, RefuseWrongNamesAndStrengthsWithTheChoices) {
  for (const EffectRow& row : effect_table()) EXPECT_TRUE(holds(refusal({"fog=1"}), row.name)) << row.name;
  EXPECT_TRUE(holds(refusal({"fog=1"}), "'fog' is unknown"));
  for (const char* text : {"noise=21", "noise=0", "noise=", "noise", "noise=much", "noise=5x", "noise=nan"}) {
    EXPECT_TRUE(holds(refusal({text}), "from 0.01 to 20 times")) << text;
  }
  EXPECT_TRUE(holds(refusal({"rays=64.5"}), "whole number from 16 to 128"));
  EXPECT_TRUE(holds(refusal({"range_bias=0"}), "not 0"));
  EXPECT_TRUE(holds(refusal({"noise=5", "noise=4"}), "given twice"));
}

TEST(Effects, AreReadAsRangesInTheSameForm) {
  const EffectRanges ranges = effect_ranges_from({"noise=1:5", "panel_turn=-30:30", "rays=64"});
  EXPECT_EQ(ranges.low.noise, 1.0);
  EXPECT_EQ(ranges.high.noise, 5.0);
  EXPECT_EQ(ranges.low.panel_turn, -30.0);
  EXPECT_EQ(ranges.high.panel_turn, 30.0);
  EXPECT_EQ(ranges.low.rays, ranges.high.rays);
  EXPECT_EQ(to_string(ranges), "panel_turn=-30:30,rays=64,noise=1:5");
  EXPECT_EQ(to_string(effect_ranges_from({"part_missing=0:3", "range_bias=-2:0"})),
            "part_missing=0:3,range_bias=-2:0");
}

TEST(Effects, RefuseWrongRangesWithTheLimits) {
  for (const char* text : {"noise=5:1", "noise=2:2", "noise=1:21", "noise=0:5", "noise=1:", "noise=:5",
                           "noise=1:2:3", "noise=1:x", "noise=:"}) {
    EXPECT_TRUE(holds(refusal({text}), "LOW:HIGH, two ascending numbers from 0.01 to 20 times, not '"))
        << text;
  }
  EXPECT_TRUE(holds(refusal({"rays=16.5:32"}), "two ascending whole numbers from 16 to 128 a side, not"));
  EXPECT_TRUE(holds(refusal({"cosine=0:30"}), "numbers from 0.1 to 20 or 0 (off), not '0:30'"));
  EXPECT_TRUE(holds(refusal({"noise=1:5", "noise=4"}), "given twice"));
}

TEST(Effects, TakeNoRangeWhereOneStrengthIsNeeded) {
  try {
    (void)effects_from({"rays=64", "noise=1:5"});
    FAIL() << "took a range for a strength";
  } catch (const std::invalid_argument& error) {
    EXPECT_TRUE(holds(error.what(), "effect noise: give one strength here; a range is possible"))
        << error.what();
  }
}

TEST(Effects, AreDrawnUniformlyAndEachByItself) {
  constexpr int kDraws = 20000;
  const EffectRanges ranges = effect_ranges_from({"noise=1:5", "part_missing=0:3", "cosine=2"});
  const EffectRanges noise_alone = effect_ranges_from({"noise=1:5"});
  double sum = 0.0, squares = 0.0;
  std::array<int, 4> parts{};
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const Effects effects = drawn(ranges, seed);
    EXPECT_TRUE(effects.noise > 1.0 && effects.noise < 5.0) << effects.noise;
    EXPECT_EQ(effects.noise, drawn(noise_alone, seed).noise);
    EXPECT_EQ(effects.cosine, 2.0);
    sum += effects.noise;
    squares += effects.noise * effects.noise;
    ++parts.at(static_cast<std::size_t>(effects.part_missing));
  }
  const double mean = sum / kDraws;
  EXPECT_NEAR(mean, 3.0, 0.04);
  EXPECT_NEAR(squares / kDraws - mean * mean, 16.0 / 12.0, 0.04);
  for (const int count : parts) EXPECT_NEAR(count, kDraws / 4, 300);
}

class Exposure : public ::testing::Test {
 protected:
  std::unique_ptr<gnc::RangeImage> rendered(Condition condition, const Effects& effects,
                                            std::uint32_t frame = 1, bool noise = true) const {
    ScenarioSettings settings{condition, 3};
    settings.sensor.noise = noise;
    settings.effects = effects;
    const FlashLidar lidar(observed_bodies(effects, "mine", mesh_));  // its panels are free to turn
    auto image = std::make_unique<gnc::RangeImage>();
    FrameRenderer(lidar, swath_m_).render(make_sequence(settings, 4, 2), frame, *image);
    return image;
  }

  TriangleMesh mesh_ = make_near_shoemaker();
  double swath_m_ = swath_m(mesh_);
};

// The chain without any effect: exact ranges, occluder, losses and noise of the condition.
TEST_F(Exposure, WithoutEffectsIsThatOfTheConditionAlone) {
  const FlashLidar lidar(mesh_);
  for (const ConditionRow& row : kConditions) {
    const Sequence sequence = make_sequence({row.condition, 3}, 4, 2);
    const FrameTruth& truth = sequence.frames[1];
    RangeGrid grid = lidar.true_ranges(truth, row.sensor.rays, swath_m_);
    occlude(truth.occluder, grid);
    auto expected = std::make_unique<gnc::RangeImage>();
    report_ranges(measured_ranges_m(grid, ray_effects(), row.sensor, noise_seed_per_frame(sequence, 1)),
                  row.sensor, fov_urad(swath_m_, truth.range_m), *expected);
    const auto image = rendered(row.condition, {});
    EXPECT_EQ(image->ranges, expected->ranges) << row.name;
    EXPECT_EQ(image->rays, row.sensor.rays) << row.name;
    EXPECT_EQ(image->fov_urad, fov_urad(swath_m_, truth.range_m)) << row.name;
  }
}

TEST_F(Exposure, WithAnEffectKeepsTheOtherRandomNumbers) {
  const auto plain = rendered(Condition::kOutliers, {});
  Effects effects;
  effects.hot_pixels = 0.01;
  const auto hot = rendered(Condition::kOutliers, effects);
  effects.dead_lines = 0.1;
  const auto both = rendered(Condition::kOutliers, effects);
  int changed = 0, dead = 0;
  for (std::size_t i = 0; i < plain->ranges.size(); ++i) {
    changed += plain->ranges[i] != hot->ranges[i];
    const bool kept = both->ranges[i] == hot->ranges[i] || both->ranges[i] == 0;
    EXPECT_TRUE(kept) << i;
    dead += both->ranges[i] != hot->ranges[i];
  }
  EXPECT_GT(changed, 100);
  EXPECT_LT(changed, 230);
  EXPECT_GT(dead, 100);
}

TEST_F(Exposure, OfEveryEffectIsAFrameOfTheSensorUnderEveryCondition) {
  for (const EffectRow& row : effect_table()) {
    Effects effects;
    effects.*row.strength = row.lowest < 0.0 ? row.highest / 2 : row.lowest;
    for (const Condition condition : {Condition::kDegraded, Condition::kOccluded}) {
      const auto image = rendered(condition, effects);
      EXPECT_EQ(image->rays, effects.rays > 0.0 ? 16 : sensor_settings(condition).rays) << row.name;
      EXPECT_GE(image->fov_urad, gnc::kMinFov_urad) << row.name;
      EXPECT_EQ(image->ranges, rendered(condition, effects)->ranges) << row.name << " is not repeatable";
    }
  }
}

// Without noise, of which lost returns and outliers change the draws.
TEST_F(Exposure, OfAnEffectThatVanishesAt0IsTheOneWithoutIt) {
  const auto plain = rendered(Condition::kNominal, {}, 1, false);
  for (const EffectRow& row : effect_table()) {
    if (!vanishes_at_0(row) || must_be_whole(row)) continue;
    Effects effects;
    effects.*row.strength = 1e-9;
    const auto image = rendered(Condition::kNominal, effects, 1, false);
    int changed = 0;
    for (std::size_t i = 0; i < plain->ranges.size(); ++i)
      changed += std::abs(plain->ranges[i] - image->ranges[i]) > 1;
    EXPECT_LE(changed, 2) << row.name;
  }
}

TEST_F(Exposure, NoiseGrowsByItsFactor) {
  Effects effects;
  effects.noise = 5.0;
  const auto plain = rendered(Condition::kNominal, {});
  const auto noisy = rendered(Condition::kNominal, effects);
  const FrameTruth truth = make_sequence({Condition::kNominal, 3}, 4, 2).frames[1];
  const RangeGrid exact = FlashLidar(mesh_).true_ranges(truth, 128, swath_m_);
  for (std::size_t i = 0; i < exact.range_m.size(); ++i) {
    if (plain->ranges[i] == 0 || noisy->ranges[i] == 0) continue;
    const double error_m = plain->ranges[i] / 128.0 - exact.range_m[i];
    const double noisy_error_m = noisy->ranges[i] / 128.0 - exact.range_m[i];
    EXPECT_NEAR(noisy_error_m, 5.0 * error_m, 6.0 / 256.0) << i;
  }
}

TEST_F(Exposure, RaysAndFieldOfViewFollowTheirEffects) {
  Effects effects;
  effects.rays = 64;
  effects.fixed_fov = 1.0;
  const auto image = rendered(Condition::kDegraded, effects);
  EXPECT_EQ(image->rays, 64);
  EXPECT_EQ(image->fov_urad, fov_urad(swath_m_, 20.0));
  effects.fixed_fov = 0.5;
  EXPECT_NEAR(rendered(Condition::kDegraded, effects)->fov_urad, 0.5 * fov_urad(swath_m_, 20.0), 1.0);
  effects.fixed_fov = 0.01;
  EXPECT_EQ(rendered(Condition::kDegraded, effects)->fov_urad, gnc::kMinFov_urad);
}

}  // namespace
}  // namespace tumblesight::sim
