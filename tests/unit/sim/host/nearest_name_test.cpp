#include "sim/host/nearest_name.hpp"

#include <gtest/gtest.h>

namespace tumblesight::sim {
namespace {

const std::vector<std::string> kNames{"sequences", "sensor", "seed", "nominal", "noise"};

TEST(NearestName, TakesTheFewestChanges) {
  EXPECT_EQ(nearest_name("sequencs", kNames), "sequences");
  EXPECT_EQ(nearest_name("sequnece", kNames), "sequences")
      << "two letters changed places, and one is missing";
  EXPECT_EQ(nearest_name("sesnor", kNames), "sensor");
  EXPECT_EQ(nearest_name("sede", kNames), "seed");
  EXPECT_EQ(nearest_name("nominall", kNames), "nominal");
}

TEST(NearestName, IsNoneWhereNothingIsNear) {
  for (const char* far : {"", "x", "se", "fog", "condition", "sphere", "seedless"})
    EXPECT_EQ(nearest_name(far, kNames), "") << far;
  EXPECT_EQ(nearest_name("seed", {"seed"}), "") << "it is known";
  EXPECT_EQ(nearest_name(std::string(100'000, 's'), kNames), "");
  EXPECT_EQ(nearest_name("sensor", {}), "");
}

TEST(NearestName, EndsAMessage) {
  EXPECT_EQ(did_you_mean("sequencs", kNames), "; did you mean 'sequences'?");
  EXPECT_EQ(did_you_mean("fog", kNames), "");
}

}  // namespace
}  // namespace tumblesight::sim
