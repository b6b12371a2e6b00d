// Verifies TS-SIL-200. Lost and frozen frames, the sensor's clock and the chaser's turn.
#include "sim/world/scenario/disturbance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "sim/world/dynamics/motion.hpp"
#include "sim/world/math/angles.hpp"
#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint64_t kSeed = 5;

Sequence disturbed(const Disturbances& disturbances, std::uint64_t index = 0,
                   Condition condition = Condition::kNominal, int frames = 10) {
  ScenarioSettings settings;
  settings.condition = condition;
  settings.frames = frames;
  settings.inertia_kg_m2 = Eigen::Vector3d(410.0, 380.0, 300.0).asDiagonal();
  settings.disturbances = disturbances;
  return make_sequence(settings, kSeed, index);
}

// One character a frame: '.' genuine, 'x' lost, a digit for the number of frames that it has been frozen.
std::string marks(const Disturbances& disturbances, std::uint64_t index = 0, int frames = 10) {
  std::string text;
  for (const FrameTruth& frame : disturbed(disturbances, index, Condition::kNominal, frames).frames) {
    text += frame.lost ? 'x' : frame.frozen_for > 0 ? static_cast<char>('0' + frame.frozen_for) : '.';
  }
  return text;
}

TEST(Disturbances, MarkTheFramesBeforeTheLast) {
  Disturbances given;
  EXPECT_EQ(marks(given), "..........");
  given.lost_frames = 2;
  EXPECT_EQ(marks(given), ".......xx.");
  given.well_frames = 3;
  EXPECT_EQ(marks(given), ".....xx...");
  given = {};
  given.frozen = 3;
  EXPECT_EQ(marks(given), "......123.");
  given.well_frames = 2;
  EXPECT_EQ(marks(given), ".....123..");
  given.lost_frames = 1;
  EXPECT_EQ(marks(given), ".....12x..");
}

TEST(Disturbances, LoseEveryNthFrameCountedBackFromTheEnd) {
  Disturbances given;
  given.loss_every = 2;
  EXPECT_EQ(marks(given), "x.x.x.x.x.");
  given.well_frames = 2;
  EXPECT_EQ(marks(given), ".x.x.x.x..");
  given.loss_every = 3;
  EXPECT_EQ(marks(given), ".x..x..x..");
  given = {};
  given.frozen = 5;
  given.loss_every = 2;
  EXPECT_EQ(marks(given), "x.x.x2x4x.");
}

TEST(Disturbances, LoseTheShareOfTheFramesButNeverTheLast) {
  Disturbances given;
  given.loss_share = 0.3;
  int lost = 0;
  for (std::uint64_t index = 0; index < 400; ++index) {
    const Sequence sequence = disturbed(given, index);
    for (const FrameTruth& frame : sequence.frames) lost += frame.lost ? 1 : 0;
    EXPECT_FALSE(sequence.frames.back().lost);
  }
  const double expected = 0.3 * 400 * 9;
  EXPECT_NEAR(lost, expected, 4.0 * std::sqrt(expected * 0.7));
  given.loss_share = 1.0;
  EXPECT_EQ(marks(given), "xxxxxxxxx.");
}

TEST(Disturbances, KeepEveryOtherDrawOfASequence) {
  const Sequence plain = disturbed({});
  Disturbances given;
  given.lost_frames = 1;
  given.loss_share = 0.4;
  given.frozen = 2;
  const Sequence marked = disturbed(given);
  EXPECT_EQ(marked.noise_seed, plain.noise_seed);
  for (std::size_t k = 0; k < plain.frames.size(); ++k) {
    EXPECT_EQ(marked.frames[k].q_lrf_trf.coeffs(), plain.frames[k].q_lrf_trf.coeffs()) << k;
    EXPECT_EQ(marked.frames[k].rate_lrf_rad_s, plain.frames[k].rate_lrf_rad_s) << k;
    EXPECT_EQ(marked.frames[k].time_ns, plain.frames[k].time_ns) << k;
    EXPECT_EQ(plain.frames[k].time_ns, static_cast<std::int64_t>(k) * kFramePeriod_ns);
    EXPECT_EQ(plain.frames[k].q_inertial_lrf.coeffs(), Eigen::Quaterniond::Identity().coeffs());
  }
}

TEST(Disturbances, AreTheSameForTheSameSeed) {
  Disturbances given;
  given.loss_share = 0.5;
  given.period_jitter = 0.2;
  given.chaser_rate_deg_s = 3.0;
  const Sequence a = disturbed(given, 3);
  const Sequence b = disturbed(given, 3);
  const Sequence other = disturbed(given, 4);
  bool differs = false;
  for (std::size_t k = 0; k < a.frames.size(); ++k) {
    EXPECT_EQ(a.frames[k].lost, b.frames[k].lost);
    EXPECT_EQ(a.frames[k].time_ns, b.frames[k].time_ns);
    EXPECT_EQ(a.frames[k].q_inertial_lrf.coeffs(), b.frames[k].q_inertial_lrf.coeffs());
    differs |= a.frames[k].lost != other.frames[k].lost;
  }
  EXPECT_TRUE(differs);
  EXPECT_NE(a.frames[5].time_ns, other.frames[5].time_ns);
}

TEST(SensorPeriod, IsTheTimeBetweenExposuresAndTheTargetTurnsByItsRateInIt) {
  Disturbances given;
  given.period_s = 5.4;
  const Sequence slow = disturbed(given);
  const Sequence plain = disturbed({});
  for (std::size_t k = 0; k < slow.frames.size(); ++k) {
    EXPECT_EQ(slow.frames[k].time_ns, static_cast<std::int64_t>(k) * 5'400'000'000);
  }
  for (std::size_t k = 0; 2 * k < plain.frames.size(); ++k) {
    EXPECT_LT(slow.frames[k].q_lrf_trf.angularDistance(plain.frames[2 * k].q_lrf_trf), 1e-9) << k;
  }
}

TEST(SensorPeriod, OfATumblingTargetFollowsTheSameMotion) {
  Disturbances given;
  given.period_s = 5.4;
  const Sequence slow = disturbed(given, 2, Condition::kTumbling);
  const Sequence plain = disturbed({}, 2, Condition::kTumbling);
  for (std::size_t k = 0; 2 * k < plain.frames.size(); ++k) {
    EXPECT_LT(slow.frames[k].q_lrf_trf.angularDistance(plain.frames[2 * k].q_lrf_trf), 1e-5) << k;
  }
}

TEST(SensorPeriod, JitterStaysWithinItsShareAndFillsIt) {
  Disturbances given;
  given.period_s = 2.0;
  given.period_jitter = 0.25;
  double least_s = 1e9, most_s = 0.0;
  for (std::uint64_t index = 0; index < 200; ++index) {
    const std::vector<FrameTruth> frames = disturbed(given, index).frames;
    for (std::size_t k = 1; k < frames.size(); ++k) {
      const double interval_s = 1e-9 * static_cast<double>(frames[k].time_ns - frames[k - 1].time_ns);
      least_s = std::min(least_s, interval_s);
      most_s = std::max(most_s, interval_s);
    }
  }
  EXPECT_GE(least_s, 1.5 - 1e-8);
  EXPECT_LT(least_s, 1.51);
  EXPECT_LE(most_s, 2.5 + 1e-8);
  EXPECT_GT(most_s, 2.49);
}

class ChaserTurn : public ::testing::TestWithParam<Condition> {};

TEST_P(ChaserTurn, LeavesTheInertialMotionOfTheTargetAsItIs) {
  Disturbances given;
  given.chaser_rate_deg_s = 5.0;
  for (std::uint64_t index = 0; index < 20; ++index) {
    const std::vector<FrameTruth> turning = disturbed(given, index, GetParam()).frames;
    const std::vector<FrameTruth> fixed = disturbed({}, index, GetParam()).frames;
    const Eigen::Quaterniond q_inertial_start = turning.front().q_inertial_lrf;
    for (std::size_t k = 0; k < turning.size(); ++k) {
      const FrameTruth& frame = turning[k];
      const Eigen::Quaterniond q_inertial_trf = frame.q_inertial_lrf * frame.q_lrf_trf;
      EXPECT_LT(q_inertial_trf.angularDistance(q_inertial_start * fixed[k].q_lrf_trf), 1e-9);
      const Eigen::Vector3d rate_inertial = frame.q_inertial_lrf * frame.rate_lrf_rad_s;
      EXPECT_LT((rate_inertial - q_inertial_start * fixed[k].rate_lrf_rad_s).norm(), 1e-9);
      EXPECT_EQ(frame.range_m, fixed[k].range_m);
    }
    EXPECT_LT(turning.front().q_lrf_trf.angularDistance(fixed.front().q_lrf_trf), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(OfASpinningAndATumblingTarget, ChaserTurn,
                         ::testing::Values(Condition::kNominal, Condition::kTumbling));

TEST(ChaserTurn, IsAtItsRateAboutOneAxis) {
  Disturbances given;
  given.chaser_rate_deg_s = 5.0;
  const std::vector<FrameTruth> frames = disturbed(given, 1).frames;
  const Eigen::Quaterniond first = frames[1].q_inertial_lrf * frames[0].q_inertial_lrf.conjugate();
  const Eigen::Quaterniond expected(
      Eigen::AngleAxisd(5.0 * kRadPerDeg * 2.7, first.vec().normalized() * (first.w() < 0 ? -1 : 1)));
  for (std::size_t k = 1; k < frames.size(); ++k) {
    const Eigen::Quaterniond step = frames[k].q_inertial_lrf * frames[k - 1].q_inertial_lrf.conjugate();
    EXPECT_LT(step.angularDistance(expected), 1e-9) << k;
  }
}

TEST(ChaserTurn, MovesTheTargetOnACircleAroundTheChaser) {
  ScenarioSettings settings;
  settings.condition = Condition::kOffset;
  settings.swath_m = 7.5;
  settings.disturbances.chaser_rate_deg_s = 1.0;
  settings.disturbances.period_s = 0.1;
  const std::vector<FrameTruth> frames = make_sequence(settings, kSeed, 2).frames;
  const auto position_m = [&](const FrameTruth& frame) -> Eigen::Vector3d {
    return frame.q_inertial_lrf *
           Eigen::Vector3d(7.5 * frame.offset_swaths.x(), frame.range_m, 7.5 * frame.offset_swaths.y());
  };
  for (std::size_t k = 1; k + 1 < frames.size(); ++k) {
    const Eigen::Vector3d velocity_m_s = (position_m(frames[k + 1]) - position_m(frames[k - 1])) / 0.2;
    EXPECT_LT((velocity_m_s - frames[k].q_inertial_lrf * frames[k].velocity_lrf_m_s).norm(), 1e-5);
    EXPECT_GT(velocity_m_s.norm(), 0.01);
  }
}

// A chaser that turns exactly with a spinning target sees it at rest.
TEST(ChaserTurn, WithTheTargetMakesItStandStill) {
  const Eigen::Quaterniond q0 = Eigen::Quaterniond(0.5, 0.1, -0.7, 0.3).normalized();
  std::vector<FrameTruth> frames(5, FrameTruth{q0, Eigen::Vector3d::Zero(), 40.0});
  const std::vector<double> times_s{0.0, 2.7, 5.4, 8.1, 10.8};
  const double rate_rad_s = 0.1;
  turn_chaser(rate_rad_s, Random(3), times_s, 8.0, frames);
  // The rate of the chaser, from its attitudes.
  const Eigen::AngleAxisd turn(frames[1].q_inertial_lrf * frames[0].q_inertial_lrf.conjugate());
  const Eigen::Vector3d rate_inertial = turn.axis() * (turn.angle() / 2.7);
  const Eigen::Vector3d rate_start = frames[0].q_inertial_lrf.conjugate() * rate_inertial;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    frames[k] = FrameTruth{spin(q0, rate_start, times_s[k]), rate_start, 40.0};
  }
  turn_chaser(rate_rad_s, Random(3), times_s, 8.0, frames);
  for (const FrameTruth& frame : frames) {
    EXPECT_LT(frame.q_lrf_trf.angularDistance(q0), 1e-9);
    EXPECT_LT((frame.rate_lrf_rad_s - rate_start).norm(), 1e-12);
  }
}

std::string refusal(const Disturbances& disturbances, std::uint32_t frames) {
  try {
    require_possible(disturbances, frames);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(Disturbances, ThatASequenceIsTooShortForAreRefusedWithTheLimit) {
  Disturbances given;
  given.lost_frames = 9;
  EXPECT_EQ(refusal(given, 10), "");
  EXPECT_EQ(
      refusal(given, 9),
      "--lost-frames 9 is too many for --frames 9 with --well-frames 1: give at most 8, or more --frames");
  given = {};
  given.frozen = 8;
  EXPECT_EQ(refusal(given, 10), "");
  given.well_frames = 2;
  EXPECT_EQ(refusal(given, 10),
            "--frozen 8 is too many for --frames 10 with --well-frames 2: give at most 7, or more --frames");
  given = {};
  given.well_frames = 11;
  EXPECT_EQ(refusal(given, 10),
            "--well-frames 11 is too many for --frames 10: give at most 10, or more --frames");
}

TEST(Disturbances, ThatBringFramesTooCloseTogetherAreRefused) {
  Disturbances given;
  given.period_s = 0.1;
  EXPECT_EQ(refusal(given, 10), "");
  given.period_jitter = 0.01;
  EXPECT_EQ(
      refusal(given, 10),
      "--period 0.1 with --period-jitter 0.01 has frames 0.099 s apart; the flight program refuses frames "
      "less than 0.1 s apart: give at least --period 0.101, or a smaller --period-jitter");
  given.period_s = 1.0;
  given.period_jitter = 0.9;
  EXPECT_EQ(refusal(given, 10), "") << "exactly at the limit";
}

TEST(Disturbances, ThatHitNoFrameAreRefused) {
  Disturbances given;
  given.loss_every = 2;
  EXPECT_EQ(refusal(given, 2), "");
  EXPECT_EQ(refusal(given, 1),
            "--loss-every has no effect: with --frames 1 and --well-frames 1 no frame can be lost; give more "
            "--frames, or fewer --well-frames");
  given = {};
  given.loss_share = 0.5;
  given.well_frames = 10;
  EXPECT_EQ(refusal(given, 11), "");
  EXPECT_NE(refusal(given, 10).find("--loss-share has no effect"), std::string::npos);
  given = {};
  given.frozen = 3;
  given.lost_frames = 2;
  EXPECT_EQ(refusal(given, 10), "");
  given.lost_frames = 3;
  EXPECT_EQ(refusal(given, 10),
            "--frozen 3 has no effect: every frozen frame is lost; freeze more frames, or lose fewer");
  given = {};
  given.frozen = 1;
  given.loss_every = 2;
  EXPECT_NE(refusal(given, 10).find("--frozen 1 has no effect"), std::string::npos);
  given.loss_every = 0;
  given.loss_share = 0.9;
  EXPECT_EQ(refusal(given, 10), "") << "it may have one";
  given.loss_share = 1.0;
  EXPECT_NE(refusal(given, 10).find("--frozen 1 has no effect"), std::string::npos);
}

TEST(Disturbances, AreNamedByTheirOptions) {
  Disturbances given;
  EXPECT_EQ(to_string(given), "");
  given.lost_frames = 1;
  given.period_s = 1.5;
  given.no_ego_motion = true;
  EXPECT_EQ(to_string(given), "lost-frames 1, period 1.5, no-ego-motion");
}

TEST(Disturbances, RowsReadAndWriteTheirOwnMember) {
  for (const DisturbanceRow& row : kDisturbances) {
    Disturbances given;
    row.set(given, row.highest);
    EXPECT_EQ(row.get(given), row.highest) << row.name;
    ASSERT_EQ(given_disturbances(given).size(), 1U) << row.name;
    EXPECT_EQ(given_disturbances(given).front(), &row);
  }
}

}  // namespace
}  // namespace tumblesight::sim
