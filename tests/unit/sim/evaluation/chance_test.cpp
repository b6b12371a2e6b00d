// Verifies TS-SIL-380.
#include "sim/evaluation/chance.hpp"

#include <gtest/gtest.h>

#include "sim/evaluation/results.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

// Density of the angle t of uniform rotations: (1 - cos t) / pi. Its mean is pi/2 + 2/pi.
TEST(Chance, IsTheMeanOfUniformRotations) {
  EXPECT_NEAR(chance_mean_deg(), kDegPerRad * (kPi / 2.0 + 2.0 / kPi), 0.1);
}

// Directions of the axis are uniform on a sphere, or on half of one.
TEST(Chance, OfABodyOfRevolutionIsThatOfItsAxis) {
  EXPECT_NEAR(chance_mean_deg(target_symmetry_from({"z:any"})), 90.0, 0.1);
  EXPECT_NEAR(chance_mean_deg(target_symmetry_from({"0.6,0.8,0:any", "z:2"})), kDegPerRad, 0.1);
}

// Twice the symmetry, half the distance to the nearest attitude at most.
TEST(Chance, FallsWithTheNumberOfEqualAttitudes) {
  double before_deg = chance_mean_deg();
  for (const char* text : {"z:2", "z:4", "z:8"}) {
    const double chance_deg = chance_mean_deg(target_symmetry_from({text}));
    EXPECT_LT(chance_deg, before_deg - 1.0) << text;
    EXPECT_GT(chance_deg, 90.0) << "the limit is the body of revolution";
    before_deg = chance_deg;
  }
}

ErrorSummary errors(double mean_deg, double within_20deg) {
  ErrorSummary made;
  made.count = 100;
  made.mean_deg = mean_deg;
  made.mean_standard_error_deg = 3.0;
  made.within_20deg = within_20deg;
  return made;
}

TEST(MostlyWrong, AreMoreThanHalf) {
  EXPECT_FALSE(is_mostly_wrong(errors(60.0, 0.5)));
  EXPECT_TRUE(is_mostly_wrong(errors(60.0, 0.49)));
  EXPECT_FALSE(is_mostly_wrong(ErrorSummary{})) << "no attitudes at all";
  EXPECT_EQ(mostly_wrong_text(errors(60.0, 0.5)), "");
}

TEST(MostlyWrong, SayWhatGuessingGives) {
  EXPECT_EQ(
      mostly_wrong_text(errors(116.0, 0.02)),
      "98 % of the attitudes are more than 20° off, and their mean error of 116.0° is what guessing gives: "
      "an attitude drawn at random is off by 126.5° on average.");
  EXPECT_EQ(mostly_wrong_text(errors(60.0, 0.4)),
            "60 % of the attitudes are more than 20° off, and their mean error of 60.0° is of no use.");
  EXPECT_NE(mostly_wrong_text(errors(92.0, 0.02), target_symmetry_from({"z:any"}))
                .find("what guessing gives: an attitude drawn at random is off by 90.0°"),
            std::string::npos);
  EXPECT_EQ(mostly_wrong_text(errors(180.0, 0.0)).find("guessing"), std::string::npos)
      << "no attitude was given";
}

TEST(MostlyWrong, IsNoVerdictOnFramesOfAnotherBody) {
  CellResult cell;
  cell.rcnn = errors(120.0, 0.0);
  EXPECT_TRUE(is_mostly_wrong(cell));
  cell.effects.noise = 20.0;
  EXPECT_TRUE(is_mostly_wrong(cell));
  cell.effects.sphere = 1.0;
  EXPECT_FALSE(is_mostly_wrong(cell));
  cell.effects.sphere = 0.0;
  cell.effects.wrong_object = 1.0;
  EXPECT_FALSE(is_mostly_wrong(cell));
}

}  // namespace
}  // namespace tumblesight::sim
