// Verifies TS-SIL-080.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "sim/world/math/angles.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "tests/unit/sim/world/scenario/uniformity.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kDraws = 2000;

Eigen::Matrix3d near_inertia() {  // paper, spacecraft table
  Eigen::Matrix3d inertia;
  inertia << 372.38, -2.86, -2.95, -2.86, 372.45, -4.42, -2.95, -4.42, 316.17;
  return inertia;
}

ScenarioSettings settings_of(Condition condition) {
  ScenarioSettings settings;
  settings.condition = condition;
  settings.inertia_kg_m2 = near_inertia();
  return settings;
}

TEST(Condition, NamesRoundTripAndUnknownOnesListAllTheKnown) {
  const std::vector<std::string> names = condition_names();
  EXPECT_EQ(names, (std::vector<std::string>{"nominal", "degraded", "occluded", "tumbling", "stress",
                                             "offset", "outliers", "approach"}));
  for (const std::string& name : names) EXPECT_EQ(to_string(condition_from(name)), name);
  try {
    condition_from("foggy");
    FAIL() << "accepted an unknown condition";
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("'foggy'"), std::string::npos) << text;
    for (const std::string& name : names) EXPECT_NE(text.find(name), std::string::npos) << text;
  }
}

TEST(Condition, RowsAreInTheOrderOfTheEnumeratorsAndExplained) {
  for (std::size_t i = 0; i < std::size(kConditions); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(kConditions[i].condition), i);
    EXPECT_NE(condition_explanations().find(kConditions[i].explanation), std::string::npos);
  }
}

// Shipped networks were trained in this order; it is part of their checkpoints' fingerprints.
TEST(Condition, IsTrainedCalibratedAndEvaluatedAsItsRowSays) {
  using C = Condition;
  const std::vector<C> all{C::kNominal, C::kDegraded, C::kOccluded, C::kTumbling, C::kOffset,
                           C::kNominal, C::kDegraded, C::kOccluded, C::kTumbling, C::kOutliers};
  EXPECT_EQ(all_training_conditions(), all);
  EXPECT_EQ(paper_training_conditions(), (std::vector<C>{C::kNominal, C::kDegraded}));
  EXPECT_EQ(calibration_conditions(),
            (std::vector<C>{C::kNominal, C::kDegraded, C::kOccluded, C::kOutliers}));
  std::vector<C> evaluated{C::kNominal, C::kDegraded, C::kOccluded, C::kTumbling, C::kOffset, C::kOutliers};
  EXPECT_EQ(evaluated_conditions("magellan"), evaluated);
  EXPECT_EQ(evaluated_conditions("mine"), evaluated);
  evaluated.insert(evaluated.begin() + 4, C::kStress);
  EXPECT_EQ(evaluated_conditions("near_shoemaker"), evaluated);
}

TEST(Condition, ChangesWhatItsRowSaysAndNeitherAttitudeNorRangeNorRateNorNoise) {
  for (int index = 0; index < 50; ++index) {
    const Sequence nominal = make_sequence(settings_of(Condition::kNominal), 3, index);
    for (const std::string& name : condition_names()) {
      const Condition condition = condition_from(name);
      const ConditionRow& row = row_of(condition);
      const Sequence other = make_sequence(settings_of(condition), 3, index);
      EXPECT_EQ(other.condition, condition);
      EXPECT_EQ(other.noise_seed, nominal.noise_seed) << name;
      ASSERT_EQ(other.frames.size(), nominal.frames.size());
      const bool free = row.rotation == RotationModel::kTorqueFree;
      for (std::size_t k = 0; k < nominal.frames.size(); ++k) {
        if (row.approaches) {
          if (k == 0) {
            EXPECT_EQ(other.frames[0].q_lrf_trf.coeffs(), nominal.frames[0].q_lrf_trf.coeffs());
          }
          EXPECT_NEAR(other.frames[k].rate_lrf_rad_s.norm(), nominal.frames[k].rate_lrf_rad_s.norm(), 1e-12);
          continue;  // approach_test.cpp
        }
        EXPECT_EQ(other.frames[k].velocity_lrf_m_s.norm(), 0.0) << name;
        EXPECT_EQ(other.frames[k].range_m, nominal.frames[k].range_m) << name;
        const bool hidden = other.frames[k].occluder.shape != OccluderShape::kNone;
        EXPECT_EQ(hidden, row.occluded) << name;
        EXPECT_EQ(other.frames[k].offset_swaths.norm() > 0.0, row.max_offset_swaths > 0.0) << name;
        EXPECT_LE(other.frames[k].offset_swaths.norm(), row.max_offset_swaths) << name;
        if (free && k > 0) continue;
        EXPECT_EQ(other.frames[k].q_lrf_trf.coeffs(), nominal.frames[k].q_lrf_trf.coeffs()) << name;
        EXPECT_LT((other.frames[k].rate_lrf_rad_s - nominal.frames[k].rate_lrf_rad_s).norm(), 1e-12) << name;
      }
    }
  }
}

TEST(Tumbling, KeepsTheAngularMomentumInTheLidarFrame) {
  for (const Condition condition : {Condition::kTumbling, Condition::kStress}) {
    Eigen::Matrix3d inertia = near_inertia();
    if (condition == Condition::kStress) inertia(2, 2) *= 0.5;
    for (int index = 0; index < 20; ++index) {
      const Sequence sequence = make_sequence(settings_of(condition), 4, index);
      const auto momentum = [&](const FrameTruth& frame) -> Eigen::Vector3d {
        return frame.q_lrf_trf * (inertia * (frame.q_lrf_trf.conjugate() * frame.rate_lrf_rad_s));
      };
      const Eigen::Vector3d first = momentum(sequence.frames.front());
      for (const FrameTruth& frame : sequence.frames) {
        EXPECT_LT((momentum(frame) - first).norm(), 1e-6 * first.norm()) << to_string(condition);
      }
    }
  }
}

TEST(Stress, IsTumblingWithTheInertiaAboutZHalved) {
  ScenarioSettings halved = settings_of(Condition::kTumbling);
  halved.inertia_kg_m2(2, 2) *= 0.5;
  double apart = 0.0;
  for (int index = 0; index < 20; ++index) {
    const Sequence stress = make_sequence(settings_of(Condition::kStress), 5, index);
    const Sequence expected = make_sequence(halved, 5, index);
    for (std::size_t k = 0; k < stress.frames.size(); ++k) {
      EXPECT_EQ(stress.frames[k].q_lrf_trf.coeffs(), expected.frames[k].q_lrf_trf.coeffs());
    }
    const Sequence tumbling = make_sequence(settings_of(Condition::kTumbling), 5, index);
    apart += stress.frames.back().q_lrf_trf.angularDistance(tumbling.frames.back().q_lrf_trf) / 20.0;
  }
  EXPECT_GT(apart, 0.2) << "the stress test hardly differs from tumbling";
}

TEST(Occluded, HidesSharesUniformOn5To30PercentBehindEveryShape) {
  std::vector<double> shares;
  std::array<int, 4> shapes{};
  for (int index = 0; index < kDraws; ++index) {
    const Occluder occluder = make_sequence(settings_of(Condition::kOccluded), 6, index).frames[0].occluder;
    shares.push_back((occluder.hidden_share - 0.05) / 0.25);
    ++shapes[static_cast<std::size_t>(occluder.shape)];
    // Nearer than the estimator's minimum range, also at the corner of the widest field of view.
    EXPECT_GT(occluder.distance_m, 1.0);
    EXPECT_LT(occluder.distance_m * std::sqrt(1.0 + 2.0 * std::pow(std::tan(20.0 * kRadPerDeg), 2)), 10.0);
  }
  EXPECT_LT(unlikeliness(shares), kUnlikely);
  EXPECT_EQ(shapes[static_cast<std::size_t>(OccluderShape::kNone)], 0);
  for (const OccluderShape shape : {OccluderShape::kArm, OccluderShape::kMast, OccluderShape::kPanelEdge}) {
    EXPECT_NEAR(shapes[static_cast<std::size_t>(shape)] / double{kDraws}, 1.0 / 3.0, 0.04);
  }
}

TEST(Occluded, TheOccluderMovesSteadilyAcrossTheFramesAndKeepsItsShapeAndShare) {
  for (int index = 0; index < 50; ++index) {
    const Sequence sequence = make_sequence(settings_of(Condition::kOccluded), 6, index);
    const auto occluder = [&](std::size_t k) { return sequence.frames[k].occluder; };
    const double turn = occluder(1).side_rad - occluder(0).side_rad;
    const double shift = occluder(1).across - occluder(0).across;
    EXPECT_NE(turn, 0.0);
    EXPECT_NE(shift, 0.0);
    for (std::size_t k = 1; k < sequence.frames.size(); ++k) {
      EXPECT_EQ(occluder(k).shape, occluder(0).shape);
      EXPECT_EQ(occluder(k).hidden_share, occluder(0).hidden_share);
      EXPECT_EQ(occluder(k).distance_m, occluder(0).distance_m);
      EXPECT_NEAR(occluder(k).side_rad - occluder(k - 1).side_rad, turn, 1e-9);
      EXPECT_NEAR(occluder(k).across - occluder(k - 1).across, shift, 1e-9);
      EXPECT_GT(occluder(k).across, 0.0);
      EXPECT_LT(occluder(k).across, 1.0);
    }
  }
}

TEST(Offset, IsAtMostAFifthOfTheSwathInAnyDirectionAndStays) {
  std::vector<double> lengths, directions;
  for (int index = 0; index < kDraws; ++index) {
    ScenarioSettings settings = settings_of(Condition::kOffset);
    settings.frames = 2;
    const Sequence sequence = make_sequence(settings, 7, index);
    const Eigen::Vector2d offset = sequence.frames[0].offset_swaths;
    EXPECT_EQ(sequence.frames[1].offset_swaths, offset);
    lengths.push_back(offset.norm() / kMaxOffset_swaths);
    directions.push_back(0.5 + std::atan2(offset.y(), offset.x()) / (2.0 * M_PI));
  }
  EXPECT_LT(unlikeliness(lengths), kUnlikely);
  EXPECT_LT(unlikeliness(directions), kUnlikely);
}

}  // namespace
}  // namespace tumblesight::sim
