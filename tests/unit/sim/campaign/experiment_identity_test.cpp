#include "sim/campaign/experiment_identity.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/unit/sim/campaign/campaign_test_support.hpp"

namespace tumblesight::sim {
namespace {

class ExperimentIdentityTest : public ::testing::Test {
 protected:
  ExperimentIdentityTest() {
    small_.subject.symmetry = target_symmetry_from({"0.6,0.8,0:any"});
    small_.subject.ranges = {1.0 / 3.0 + 20.0, 77.7, 0.1};
    small_.settings.effects = effects_from({"noise=0.3", "panel_turn=12.5"});
    small_.settings.disturbances.loss_share = 0.1;
    json_ = to_json(identity_of(small_.subject, small_.settings, "1.2.3"));
  }
  std::string error_with(const char* key, const nlohmann::ordered_json& value) const {
    nlohmann::ordered_json changed = json_;
    changed[key] = value;
    return error_of([&] { (void)identity_from(changed); });
  }

  SmallEvaluation small_;
  nlohmann::ordered_json json_;
};

TEST_F(ExperimentIdentityTest, ComesBackWithAllBits) {
  const ExperimentIdentity again = identity_from(nlohmann::ordered_json::parse(json_.dump()));
  EXPECT_EQ(to_json(again), json_);
  EXPECT_EQ(difference(again, identity_of(small_.subject, small_.settings, "1.2.3")), "");
  EXPECT_EQ(again.subject.ranges.nearest_m, small_.subject.ranges.nearest_m);
  EXPECT_EQ(again.settings.seed, small_.settings.seed);
  EXPECT_EQ(to_string(again.subject.symmetry), to_string(small_.subject.symmetry));
}

TEST_F(ExperimentIdentityTest, WhatNoProgramWroteIsRefused) {
  EXPECT_NE(error_with("frames", 0), "no error");
  EXPECT_NE(error_with("frames", 4'000'000'000U), "no error");
  EXPECT_NE(error_with("sequences", 0), "no error");
  EXPECT_NE(error_with("sequences", 20'000'000), "no error");
  EXPECT_NE(error_with("conditions", nlohmann::ordered_json::array()), "no error");
  EXPECT_NE(error_with("conditions", {"sunny"}), "no error");
  EXPECT_NE(error_with("effects", {{"noize", 1.0}}), "no error");
  EXPECT_NE(error_with("inertia_kg_m2", {1.0, 2.0}), "no error");
  EXPECT_NE(error_with("model_crc32", "xyz"), "no error");
  EXPECT_NE(error_with("symmetry", {{1.0}}), "no error");
  EXPECT_NE(error_with("sensor", {{"name", "x"}}), "no error");
  EXPECT_NE(error_with("seed", "one"), "no error");
}

}  // namespace
}  // namespace tumblesight::sim
