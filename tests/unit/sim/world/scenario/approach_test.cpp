// The condition `approach`: path, attitude of the chaser, mounting and lost frames.
#include "sim/world/scenario/approach.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "gnc/attitude/rotation.hpp"
#include "sim/world/chaser_navigation.hpp"
#include "sim/world/math/angles.hpp"
#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kSwath_m = 7.5;
constexpr int kMany = 300;

ScenarioSettings settings_of(int frames, double swath_m = kSwath_m) {
  ScenarioSettings settings;
  settings.condition = Condition::kApproach;
  settings.frames = frames;
  settings.swath_m = swath_m;
  return settings;
}

Sequence sequence_of(int frames, std::uint64_t index, double swath_m = kSwath_m) {
  return make_sequence(settings_of(frames, swath_m), 9, index);
}

double time_s(const FrameTruth& frame) {
  return 1e-9 * static_cast<double>(frame.time_ns);
}

Eigen::Vector3d origin_lrf_m(const FrameTruth& frame, double swath_m = kSwath_m) {
  return {swath_m * frame.offset_swaths.x(), frame.range_m, swath_m * frame.offset_swaths.y()};
}

TEST(Approach, StaysWithinItsRangesAndTheView) {
  for (const int frames : {1, 2, 10, 40, 100, 1000}) {
    for (const double swath_m : {4.0, kSwath_m, 15.0}) {
      for (int index = 0; index < 60; ++index) {
        for (const FrameTruth& frame : sequence_of(frames, index, swath_m).frames) {
          EXPECT_GE(frame.range_m, kNearestApproach_m);
          EXPECT_LE(frame.range_m, kFarthestApproach_m);
          EXPECT_LT(frame.offset_swaths.norm(), 0.3);
        }
      }
    }
  }
}

TEST(Approach, PositionInInertialAxesMovesAtTheStatedConstantVelocity) {
  for (int index = 0; index < kMany; ++index) {
    const std::vector<FrameTruth> frames = sequence_of(40, index).frames;
    const auto velocity_m_s = [](const FrameTruth& frame) -> Eigen::Vector3d {
      return frame.q_inertial_lrf * frame.velocity_lrf_m_s;
    };
    for (std::size_t k = 1; k < frames.size(); ++k) {
      const Eigen::Vector3d moved_m = frames[k].q_inertial_lrf * origin_lrf_m(frames[k]) -
                                      frames[k - 1].q_inertial_lrf * origin_lrf_m(frames[k - 1]);
      const double elapsed_s = time_s(frames[k]) - time_s(frames[k - 1]);
      EXPECT_LT((moved_m / elapsed_s - velocity_m_s(frames[k])).norm(), 1e-9);
      EXPECT_LT((velocity_m_s(frames[k]) - velocity_m_s(frames[0])).norm(), 1e-12);
    }
  }
}

TEST(Approach, ClosesInAtUpToHalfAMetrePerSecondAndStartsFarAwayIfTheSequenceIsLong) {
  double least_m_s = 1.0, most_m_s = 0.0, fastest_drift_m_s = 0.0;
  double nearest_start_m = 1e3, farthest_start_m = 0.0;
  for (int index = 0; index < kMany; ++index) {
    const FrameTruth first = sequence_of(10, index).frames.front();
    const double speed_m_s = first.velocity_lrf_m_s.norm();
    least_m_s = std::min(least_m_s, speed_m_s);
    most_m_s = std::max(most_m_s, speed_m_s);
    nearest_start_m = std::min(nearest_start_m, first.range_m);
    farthest_start_m = std::max(farthest_start_m, first.range_m);
    EXPECT_LT(first.velocity_lrf_m_s.y(), -0.04);
    fastest_drift_m_s =
        std::max(fastest_drift_m_s, std::hypot(first.velocity_lrf_m_s.x(), first.velocity_lrf_m_s.z()));

    const std::vector<FrameTruth> longer = sequence_of(200, index).frames;  // 537 s for less than 88 m
    const double slowed_m_s = -longer.front().velocity_lrf_m_s.y();
    EXPECT_LT(slowed_m_s, 0.17);
    if (slowed_m_s < 0.163) continue;  // the speed that was drawn
    EXPECT_NEAR(longer.front().range_m, 100.0, 0.5);
    EXPECT_NEAR(longer.back().range_m, 12.0, 0.5);
  }
  EXPECT_NEAR(least_m_s, 0.05, 0.02);
  EXPECT_NEAR(most_m_s, 0.5, 0.02);
  EXPECT_LT(nearest_start_m, 20.0);
  EXPECT_GT(farthest_start_m, 98.0);
  EXPECT_GT(fastest_drift_m_s, 0.04);
  EXPECT_LE(fastest_drift_m_s, 0.05 * std::sqrt(2.0) + 0.5 * 0.05);  // the chaser's axes are turned a little
}

// Turn of the chaser between two exposures, in degrees.
double turned_deg(const FrameTruth& from, const FrameTruth& to) {
  return kDegPerRad * from.q_inertial_lrf.angularDistance(to.q_inertial_lrf);
}

TEST(Approach, TurnsTheChaserAtAConstantRateWithJitter) {
  double fastest_deg_s = 0.0, squares_deg2 = 0.0;
  int count = 0;
  for (int index = 0; index < kMany; ++index) {
    const std::vector<FrameTruth> frames = sequence_of(10, index).frames;
    const double elapsed_s = time_s(frames.back());
    fastest_deg_s = std::max(fastest_deg_s, turned_deg(frames.front(), frames.back()) / elapsed_s);
    // Without jitter two successive turns are the same one.
    for (std::size_t k = 2; k < frames.size(); ++k) {
      const Eigen::Quaterniond first =
          frames[k - 2].q_inertial_lrf.conjugate() * frames[k - 1].q_inertial_lrf;
      const Eigen::Quaterniond second = frames[k - 1].q_inertial_lrf.conjugate() * frames[k].q_inertial_lrf;
      squares_deg2 += std::pow(kDegPerRad * first.angularDistance(second), 2);
      ++count;
    }
  }
  EXPECT_GT(fastest_deg_s, 0.15);
  EXPECT_LT(fastest_deg_s, 0.21);
  // a - 2 b + c of three jitters: six times the variance, on three axes.
  EXPECT_NEAR(std::sqrt(squares_deg2 / count / 18.0), 0.02, 0.001);
}

TEST(Approach, LeavesTheInertialMotionOfTheTargetAsItIs) {
  for (int index = 0; index < 50; ++index) {
    ScenarioSettings nominal = settings_of(20);
    nominal.condition = Condition::kNominal;
    const std::vector<FrameTruth> fixed = make_sequence(nominal, 9, index).frames;
    const std::vector<FrameTruth> frames = sequence_of(20, index).frames;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const Eigen::Quaterniond q_inertial_trf = frames[k].q_inertial_lrf * frames[k].q_lrf_trf;
      const Eigen::Quaterniond expected = frames[0].q_inertial_lrf * fixed[k].q_lrf_trf;
      EXPECT_LT(q_inertial_trf.angularDistance(expected), 1e-9);
      EXPECT_LT((frames[k].q_inertial_lrf * frames[k].rate_lrf_rad_s -
                 frames[0].q_inertial_lrf * fixed[k].rate_lrf_rad_s)
                    .norm(),
                1e-9);
    }
  }
}

TEST(Approach, StatesTheChasersAttitudeWithAConstantErrorOfTheMounting) {
  double squares_deg2 = 0.0;
  for (int index = 0; index < kMany; ++index) {
    const std::vector<FrameTruth> frames = sequence_of(5, index).frames;
    for (const FrameTruth& frame : frames) {
      const Eigen::Quaterniond stated = gnc::to_double(chaser_attitude(frame, 0, true).q_inertial_lrf);
      const Eigen::Quaterniond off = frame.q_inertial_lrf.conjugate() * stated;
      EXPECT_LT(off.angularDistance(frames[0].q_lrf_stated), 1e-7);
    }
    squares_deg2 +=
        std::pow(kDegPerRad * frames[0].q_lrf_stated.angularDistance(Eigen::Quaterniond::Identity()), 2);
  }
  EXPECT_NEAR(std::sqrt(squares_deg2 / kMany / 3.0), 0.12, 0.01);
}

TEST(Approach, LosesSingleFramesButNeitherTheFirstNorTheLast) {
  int lost = 0, could_be = 0;
  for (int index = 0; index < kMany; ++index) {
    const std::vector<FrameTruth> frames = sequence_of(40, index).frames;
    EXPECT_FALSE(frames.front().lost);
    EXPECT_FALSE(frames.back().lost);
    for (std::size_t k = 1; k + 1 < frames.size(); ++k) {
      EXPECT_FALSE(frames[k].lost && frames[k - 1].lost);
      lost += frames[k].lost ? 1 : 0;
      ++could_be;
    }
  }
  EXPECT_NEAR(lost / double(could_be), 0.05 / 1.05, 0.006);
}

TEST(Approach, IsTheSameForTheSameSeed) {
  const std::vector<FrameTruth> a = sequence_of(10, 3).frames, b = sequence_of(10, 3).frames;
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(origin_lrf_m(a[k]), origin_lrf_m(b[k]));
    EXPECT_EQ(a[k].velocity_lrf_m_s, b[k].velocity_lrf_m_s);
    EXPECT_EQ(a[k].q_inertial_lrf.coeffs(), b[k].q_inertial_lrf.coeffs());
    EXPECT_EQ(a[k].q_lrf_trf.coeffs(), b[k].q_lrf_trf.coeffs());
    EXPECT_EQ(a[k].lost, b[k].lost);
  }
  EXPECT_NE(a[0].range_m, sequence_of(10, 4).frames[0].range_m);
}

TEST(Approach, KeepsToRangesThatAreGiven) {
  ScenarioSettings settings = settings_of(30);
  settings.ranges = {50.0, 60.0};
  for (int index = 0; index < 50; ++index) {
    for (const FrameTruth& frame : make_sequence(settings, 9, index).frames) {
      EXPECT_GE(frame.range_m, 50.0);
      EXPECT_LE(frame.range_m, 60.0);
    }
  }
  settings = settings_of(10);
  settings.range_m = 42.0;
  EXPECT_NEAR(make_sequence(settings, 9, 0).frames[0].range_m, 42.0, 0.1);
}

TEST(Approach, RefusesASecondTurnOfTheChaser) {
  ScenarioSettings settings = settings_of(10);
  settings.disturbances.chaser_rate_deg_s = 1.0;
  try {
    make_sequence(settings, 9, 0);
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("--chaser-rate 1"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("approach"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tumblesight::sim
