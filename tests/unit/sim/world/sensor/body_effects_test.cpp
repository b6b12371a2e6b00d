// Verifies TS-SIL-300, TS-SIL-340. The bodies that are observed in place of the model.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include "sim/world/math/angles.hpp"
#include "sim/world/scenario/condition.hpp"
#include "sim/world/sensor/effects.hpp"
#include "sim/world/sensor/flash_lidar.hpp"
#include "sim/world/target/panels.hpp"
#include "sim/world/target/primitives.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

constexpr const char* kNear = "near_shoemaker";

std::vector<TriangleMesh> bodies(const char* effect, const std::string& target = kNear) {
  return observed_bodies(effect_ranges_from({effect}), target, target_by_name(target));
}

std::string refusal(const char* effect, const TriangleMesh& mesh, const std::string& target = "mine") {
  try {
    (void)observed_bodies(effects_from({effect}), target, mesh);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(BodyEffects, WithoutThemTheBodyIsTheMesh) {
  const TriangleMesh mesh = target_by_name(kNear);
  const std::vector<TriangleMesh> same = observed_bodies({}, kNear, mesh);
  ASSERT_EQ(same.size(), 1U);
  EXPECT_EQ(same.front().triangles, mesh.triangles);
  EXPECT_EQ(same.front().vertices_trf_m, mesh.vertices_trf_m);
}

TEST(BodyEffects, PanelsTurnAboutTheirHingesAndNothingElseMoves) {
  const TriangleMesh before = target_by_name(kNear);
  const TriangleMesh after = bodies("panel_turn=10").front();
  ASSERT_EQ(after.triangles.size(), before.triangles.size());
  for (std::size_t i = 0; i < before.triangles.size(); ++i) {
    if (before.is_panel[i] != 0) continue;
    EXPECT_EQ(after.triangles[i], before.triangles[i]);
  }
  const std::vector<Panel> flat = find_panels(before), turned = find_panels(after);
  ASSERT_EQ(flat.size(), 4U);
  ASSERT_EQ(turned.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT((flat[i].centre_trf_m - turned[i].centre_trf_m).norm(), 1e-5);
    EXPECT_LT((flat[i].hinge_trf - turned[i].hinge_trf).norm(), 1e-5);
    const double cosine = std::abs(flat[i].normal_trf.dot(turned[i].normal_trf));
    EXPECT_NEAR(kDegPerRad * std::acos(cosine), 10.0, 1e-3);
  }
}

// By how much a panel has turned about its hinge. Its corners are expected where a rotation about the hinge
// puts them.
double turned_deg(const Panel& panel, const TriangleMesh& before, const TriangleMesh& after) {
  const auto arm = [&](const TriangleMesh& mesh, std::size_t triangle, int corner) -> Eigen::Vector3d {
    return mesh.vertices_trf_m[mesh.triangles[triangle][corner]].cast<double>() - panel.centre_trf_m;
  };
  const Eigen::Vector3d& hinge = panel.hinge_trf;
  const auto across = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d { return v - hinge.dot(v) * hinge; };
  const Eigen::Vector3d from = across(arm(before, panel.triangles.front(), 0));
  const Eigen::Vector3d to = across(arm(after, panel.triangles.front(), 0));
  const double angle_rad = std::atan2(hinge.dot(from.cross(to)), from.dot(to));
  for (const std::size_t triangle : panel.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      const Eigen::Vector3d expected = Eigen::AngleAxisd(angle_rad, hinge) * arm(before, triangle, corner);
      EXPECT_LT((arm(after, triangle, corner) - expected).norm(), 1e-5) << triangle;
    }
  }
  return kDegPerRad * angle_rad;
}

// The angles of every panel in every body. What is no panel must not have moved.
std::vector<std::vector<double>> angles_deg(const char* effect, const std::string& target) {
  const TriangleMesh before = target_by_name(target);
  std::vector<std::vector<double>> angles;
  for (const TriangleMesh& after : bodies(effect, target)) {
    for (std::size_t i = 0; i < before.triangles.size(); ++i) {
      if (before.is_panel[i] == 0) EXPECT_EQ(after.triangles[i], before.triangles[i]);
    }
    angles.emplace_back();
    for (const Panel& panel : find_panels(before)) angles.back().push_back(turned_deg(panel, before, after));
  }
  return angles;
}

void expect_drawn_within(const std::vector<std::vector<double>>& angles, std::size_t panels, double low_deg,
                         double high_deg) {
  ASSERT_EQ(angles.size(), kDrawnBodies);
  std::set<double> all;
  for (const std::vector<double>& of_body : angles) {
    ASSERT_EQ(of_body.size(), panels);
    all.insert(of_body.begin(), of_body.end());
  }
  EXPECT_EQ(all.size(), panels * kDrawnBodies) << "an angle of its own for each panel of each body";
  const double span_deg = high_deg - low_deg;
  EXPECT_GE(*all.begin(), low_deg);
  EXPECT_LT(*all.begin(), low_deg + 0.2 * span_deg);
  EXPECT_LE(*all.rbegin(), high_deg);
  EXPECT_GT(*all.rbegin(), high_deg - 0.2 * span_deg);
}

TEST(BodyEffects, JointsStandWithinTheirShareOfTheLimits) {
  expect_drawn_within(angles_deg("joints=1", "magellan"), 2, -180.0, 180.0);
  expect_drawn_within(angles_deg("joints=0.25", "magellan"), 2, -45.0, 45.0);
  const auto whole = angles_deg("joints=1", "magellan"), quarter = angles_deg("joints=0.25", "magellan");
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (std::size_t panel = 0; panel < 2; ++panel) EXPECT_NEAR(quarter[i][panel], whole[i][panel] / 4, 1e-3);
  }
}

TEST(BodyEffects, JointsOfFixedPanelsAreRefusedWithTheEffectThatTurnsThem) {
  for (const char* target : {kNear, "sacd_aquarius", "sacd_aquarius_stowed"}) {
    const std::string message = refusal("joints=1", target_by_name(target), target);
    EXPECT_NE(message.find("the panels of " + display_name(target) + " are fixed"), std::string::npos)
        << message;
    EXPECT_NE(message.find("panel_turn"), std::string::npos) << message;
  }
}

TEST(BodyEffects, StrengthsOfPanelsAreDrawnForEachPanelOfABoundedNumberOfBodies) {
  expect_drawn_within(angles_deg("panel_turn=-30:10", kNear), 4, -30.0, 10.0);
  EXPECT_EQ(angles_deg("panel_turn=10", kNear).size(), 1U);
  EXPECT_EQ(angles_deg("panel_turn=-30:10", kNear), angles_deg("panel_turn=-30:10", kNear));
}

TEST(BodyEffects, AWholeStrengthIsDrawnAsANumberOfParts) {
  std::set<std::size_t> triangles;
  for (const TriangleMesh& body : bodies("part_missing=0:2", "magellan"))
    triangles.insert(body.triangles.size());
  std::set<std::size_t> expected{target_by_name("magellan").triangles.size()};
  for (const char* effect : {"part_missing=1", "part_missing=2"})
    expected.insert(bodies(effect, "magellan").front().triangles.size());
  EXPECT_EQ(triangles, expected);
}

// A bus of radius 2 m with instruments: the parts that can be missing are 0.33 to 0.5 m across.
TEST(BodyEffects, TheOutermostPartsAreMissing) {
  const auto cube = [](float edge, float x, float y) {
    return placed(box({edge, edge, edge}), Eigen::Isometry3f(Eigen::Translation3f(x, y, 0.0F)));
  };
  const TriangleMesh bus = box({2.3F, 2.3F, 2.3F});
  ASSERT_NEAR(bus.radius_m(), 2.0F, 0.01F);
  const TriangleMesh parts[] = {bus, cube(0.25F, 1.3F, 0.0F), cube(0.25F, 0.0F, 1.4F),  // 0.43 m across
                                cube(0.15F, 0.0F, -1.4F), cube(0.35F, -1.4F, 0.0F)};    // 0.26 m, 0.61 m
  TriangleMesh whole;
  for (const TriangleMesh& part : parts) append(whole, part);
  const auto missing_parts = [&](const char* effect) {
    const TriangleMesh left = observed_bodies(effects_from({effect}), "mine", whole).front();
    const std::set<std::array<std::uint32_t, 3>> kept(left.triangles.begin(), left.triangles.end());
    std::set<std::size_t> missing;
    for (std::size_t i = 0; i < whole.triangles.size(); ++i) {
      if (kept.count(whole.triangles[i]) == 0) missing.insert(i / 12);
    }
    return missing;
  };
  EXPECT_EQ(missing_parts("part_missing=1"), std::set<std::size_t>{2});
  EXPECT_EQ(missing_parts("part_missing=2"), (std::set<std::size_t>{1, 2}));
  EXPECT_NE(refusal("part_missing=3", whole).find("only 2 separate parts"), std::string::npos);
  const TriangleMesh without = bodies("part_missing=1").front();
  EXPECT_LT(without.triangles.size(), target_by_name(kNear).triangles.size());
  EXPECT_EQ(find_panels(without).size(), 4U);
}

TEST(BodyEffects, TheWrongObjectIsEachOtherSpacecraft) {
  const auto names = [](const std::string& target) {
    std::set<std::string> found;
    for (const TriangleMesh& body : bodies("wrong_object=1", target)) found.insert(body.name);
    return found;
  };
  EXPECT_EQ(names(kNear), (std::set<std::string>{"magellan", "sacd_aquarius", "sacd_aquarius_stowed"}));
  EXPECT_EQ(names("sacd_aquarius"), (std::set<std::string>{"near_shoemaker", "magellan"}));
}

TEST(BodyEffects, SequencesShowEachOfTheBodies) {
  const FlashLidar both(std::vector<TriangleMesh>{box({1.0F, 1.0F, 1.0F}), box({3.0F, 3.0F, 3.0F})});
  std::set<double> nearest_m;
  for (std::uint64_t sequence = 0; sequence < 20; ++sequence) {
    FrameTruth truth{Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 30.0};
    truth.scene_seed = sequence;
    const RangeGrid grid = both.true_ranges(truth, 32, 4.0);
    const double range_m = *std::min_element(grid.range_m.begin(), grid.range_m.end());
    nearest_m.insert(std::round(10.0 * range_m) / 10.0);
    EXPECT_EQ(both.true_ranges(truth, 32, 4.0).range_m, grid.range_m);
  }
  EXPECT_EQ(nearest_m, (std::set<double>{28.5, 29.5}));
}

TEST(BodyEffects, ASphereHasItsRadiusEverywhere) {
  const float radius_m = target_by_name(kNear).radius_m();
  for (const auto& [effect, factor] : {std::pair{"sphere=1", 1.0F}, std::pair{"sphere=0.5", 0.5F}}) {
    const TriangleMesh sphere = bodies(effect).front();
    for (const Eigen::Vector3f& v : sphere.vertices_trf_m) EXPECT_NEAR(v.norm(), factor * radius_m, 1e-4F);
    // A closed surface of 48 rings is at most 0.2 % smaller than the sphere.
    std::vector<std::size_t> all(sphere.triangles.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    EXPECT_NEAR(area_m2(sphere, all) / (4.0 * kPi * factor * radius_m * factor * radius_m), 1.0, 0.003);
  }
}

TEST(BodyEffects, JointsOfAnotherBodyAreRefused) {
  for (const char* other : {"wrong_object=1", "sphere=1"}) {
    const Effects effects = effects_from({"joints=1", other});
    EXPECT_THROW((void)observed_bodies(effects, "magellan", target_by_name("magellan")),
                 std::invalid_argument)
        << other;
  }
}

TEST(BodyEffects, APanelEffectNeedsPanels) {
  for (const char* effect : {"joints=1", "panel_turn=10", "panel_lobe=40"}) {
    EXPECT_NE(refusal(effect, box({1.0F, 1.0F, 1.0F})).find("no solar panels are found"), std::string::npos);
  }
  EXPECT_EQ(bodies("panel_lobe=40").front().is_panel, target_by_name(kNear).is_panel);
}

}  // namespace
}  // namespace tumblesight::sim
