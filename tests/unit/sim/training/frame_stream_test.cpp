// Verifies TS-TRN-040.
#include "sim/training/frame_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/training/export_model.hpp"
#include "sim/training/sequence_features.hpp"
#include "sim/world/math/random.hpp"
#include "sim/world/target/shipped_meshes.hpp"

namespace tumblesight::sim {
namespace {

TEST(Turned, EqualsARenderingOfTheTurnedAttitude) {
  const TriangleMesh mesh = make_near_shoemaker();
  const FlashLidar lidar(mesh);
  const TrainingTargets targets = make_training_targets({mesh}, paper_training_conditions());
  SensorSettings settings;
  settings.noise = false;
  const auto frame = std::make_unique<gnc::RangeImage>();
  const auto scratch = std::make_unique<gnc::DepthImageScratch>();
  const auto image = std::make_unique<gnc::DepthImage>();
  const auto render = [&](const Eigen::Quaterniond& q) {
    lidar.expose({q, Eigen::Vector3d::Zero(), 30.0}, settings, 1e-3 * targets.projection.swath_mm, 1, *frame);
    EXPECT_EQ(make_depth_image(*frame, targets.projection, *scratch, *image), gnc::FrameStatus::kOk);
    torch::Tensor tensor = torch::empty({1, 1, 100, 100});
    float* to = tensor.data_ptr<float>();
    for (const std::uint16_t depth : image->depth) *to++ = static_cast<float>(depth) / 65536.0F;
    return tensor;
  };
  const Eigen::Quaterniond q = Eigen::Quaterniond(0.8, -0.3, 0.4, 0.2).normalized();
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> r = q.toRotationMatrix().cast<float>();
  const FrameBatch straight{render(q), torch::from_blob(const_cast<float*>(r.data()), {1, 3, 3}).clone()};
  for (int turns = 1; turns < 4; ++turns) {
    const FrameBatch batch = turned(straight, turns);
    Eigen::Matrix3d labelled;
    for (int i = 0; i < 9; ++i) labelled(i / 3, i % 3) = batch.r_view_trf[0][i / 3][i % 3].item<double>();
    const torch::Tensor difference = (batch.images - render(Eigen::Quaterniond(labelled))).abs();
    EXPECT_LT((difference > 0.05).to(torch::kFloat).mean().item<double>(), 0.01)
        << turns;  // rounding at edges may differ
  }
}

TEST(FrameStream, IsTheSameWithAnyNumberOfWorkersAndFromAnyStart) {
  const TrainingTargets targets = make_training_targets({make_near_shoemaker()}, paper_training_conditions());
  FrameStream one(targets, 5, 4, 0, 1), three(targets, 5, 4, 0, 3), later(targets, 5, 4, 3, 2),
      other(targets, 6, 4, 0, 1);
  for (int i = 0; i < 6; ++i) {
    const FrameBatch a = one.next();
    const FrameBatch b = three.next();
    EXPECT_TRUE(torch::equal(a.images, b.images)) << i;
    EXPECT_TRUE(torch::equal(a.r_view_trf, b.r_view_trf)) << i;
    if (i >= 3) {
      EXPECT_TRUE(torch::equal(a.images, later.next().images)) << i;
    }
    EXPECT_FALSE(torch::equal(a.images, other.next().images)) << i;
  }
}

TEST(FrameStream, HandsOutEachRenderedGroupInItsFourQuarterTurns) {
  const TrainingTargets targets = make_training_targets({make_near_shoemaker()}, all_training_conditions());
  FrameStream stream(targets, 5, 4, 0, 1);
  for (std::uint64_t group = 0; group < 2; ++group) {
    const FrameBatch rendered = render_frames(targets, 5, group, 4);
    for (std::int64_t turns = 0; turns < 4; ++turns) {
      const FrameBatch batch = stream.next();
      const FrameBatch expected = turned(rendered, turns);
      EXPECT_TRUE(torch::equal(batch.images, expected.images)) << group << ' ' << turns;
      EXPECT_TRUE(torch::allclose(batch.r_view_trf, expected.r_view_trf)) << group << ' ' << turns;
    }
  }
}

TEST(FrameStream, ConditionsTakeTurns) {
  const TriangleMesh mesh = make_near_shoemaker();
  const FrameBatch nominal = render_frames(make_training_targets({mesh}, {Condition::kNominal}), 5, 0, 4);
  const FrameBatch both =
      render_frames(make_training_targets({mesh}, {Condition::kNominal, Condition::kOccluded}), 5, 0, 4);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(torch::equal(both.images[i], nominal.images[i]), i % 2 == 0) << i;
  }
  // The occluded frames are of the same attitudes, and have fewer cells with returns.
  const auto filled = [](const torch::Tensor& image) { return (image > 0.0).sum().item<std::int64_t>(); };
  for (const int i : {1, 3}) EXPECT_LT(filled(both.images[i]), filled(nominal.images[i])) << i;
}

// Verifies TS-SIL-300.
TEST(FrameStream, FramesHaveTheEffects) {
  const TriangleMesh mesh = make_near_shoemaker();
  const TrainingTargets plain = make_training_targets({mesh}, {Condition::kNominal});
  const TrainingTargets thin = make_training_targets(
      {mesh}, {Condition::kNominal}, Eigen::Matrix3d::Identity(), {effects_from({"dropout=0.6"})});
  EXPECT_EQ(thin.projection.swath_mm, plain.projection.swath_mm);
  const auto filled = [](const FrameBatch& batch) { return (batch.images > 0.0).sum().item<std::int64_t>(); };
  EXPECT_LT(filled(render_frames(thin, 5, 0, 4)), filled(render_frames(plain, 5, 0, 4)));
  EXPECT_GT(filled(render_frames(thin, 5, 0, 4)), 0);
}

TEST(FrameStream, SetsOfEffectsTakeTurnsAfterTheConditions) {
  const TriangleMesh mesh = make_near_shoemaker();
  const std::vector<Condition> conditions{Condition::kNominal, Condition::kOccluded};
  const auto with = [&](const std::vector<EffectRanges>& sets) {
    return render_frames(make_training_targets({mesh}, conditions, Eigen::Matrix3d::Identity(), sets), 5, 0,
                         12)
        .images;
  };
  const Effects thin = effects_from({"dropout=0.6"});
  const Effects turned_panels = effects_from({"panel_turn=60"});
  const torch::Tensor none = with({}), all_thin = with({thin}), all_turned = with({turned_panels}),
                      mixed = with({{}, thin, turned_panels});
  for (int i = 0; i < 12; ++i) {
    const int set = i / 2 % 3;
    EXPECT_EQ(torch::equal(mixed[i], none[i]), set == 0) << i;
    EXPECT_EQ(torch::equal(mixed[i], all_thin[i]), set == 1) << i;
    EXPECT_EQ(torch::equal(mixed[i], all_turned[i]), set == 2) << i;
  }
}

// Verifies TS-SIL-340. A frame with a drawn strength is the one with that strength given.
TEST(FrameStream, FramesDrawTheStrengthsOfARange) {
  const auto targets_with = [](const EffectRanges& effects) {
    return make_training_targets({make_near_shoemaker()}, {Condition::kNominal}, Eigen::Matrix3d::Identity(),
                                 {effects});
  };
  const TrainingTargets ranged = targets_with(effect_ranges_from({"dropout=0.1:0.9"}));
  const FrameBatch frames = render_frames(ranged, 5, 0, 4);
  for (int i = 0; i < 4; ++i) {
    const ScenarioSettings scenario =
        scenario_of(ranged, Condition::kNominal, ranged.effect_sets.front().effects, 1);
    const Effects fixed = make_sequence(scenario, mix(5, 0), static_cast<std::uint64_t>(i)).effects;
    EXPECT_TRUE(torch::equal(frames.images[i], render_frames(targets_with(fixed), 5, 0, 4).images[i])) << i;
  }
}

// Verifies TS-SIL-340.
TEST(FrameStream, WithRangesIsTheSameWithAnyNumberOfWorkersAndFromAnyStart) {
  const TrainingTargets targets =
      make_training_targets({make_near_shoemaker()}, {Condition::kNominal}, Eigen::Matrix3d::Identity(),
                            {effect_ranges_from({"dropout=0.1:0.9", "panel_turn=-60:60"})});
  FrameStream one(targets, 5, 4, 0, 1), three(targets, 5, 4, 0, 3), later(targets, 5, 4, 3, 2);
  for (int i = 0; i < 6; ++i) {
    const torch::Tensor images = one.next().images;
    EXPECT_TRUE(torch::equal(images, three.next().images)) << i;
    if (i >= 3) {
      EXPECT_TRUE(torch::equal(images, later.next().images)) << i;
    }
  }
}

TEST(FrameStream, ASetOfEffectsThatHidesTheTargetIsRefusedByItsName) {
  try {
    make_training_targets({make_near_shoemaker()}, paper_training_conditions(), Eigen::Matrix3d::Identity(),
                          {{}, effects_from({"dead_pixels=0.9", "dropout=0.99"})});
    FAIL() << "accepted effects with which nothing is seen";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(" with dropout=0.99,dead_pixels=0.9: "), std::string::npos)
        << error.what();
  }
}

TEST(SequenceFeatures, SetsOfEffectsTakeTurnsAfterConditionsAndLawsOfTheRate) {
  const auto weights = std::make_unique<gnc::NetworkWeights<gnc::Float32>>();
  torch::manual_seed(5);
  export_weights(Cnn(), Recurrent(), *weights);
  const auto with = [&](const std::vector<EffectRanges>& sets) {
    const TrainingTargets targets = make_training_targets({make_near_shoemaker()}, {Condition::kNominal},
                                                          Eigen::Matrix3d::Identity(), sets);
    SequenceFeatures supply(targets, *weights, 5, 8, 2);
    return supply.first(8).hypotheses.features;
  };
  const Effects thin = effects_from({"dropout=0.6"});
  const torch::Tensor none = with({}), all_thin = with({thin}), mixed = with({{}, thin});
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(torch::equal(mixed[i], none[i]), i / 2 % 2 == 0) << i;
    EXPECT_EQ(torch::equal(mixed[i], all_thin[i]), i / 2 % 2 == 1) << i;
  }
}

// A sensor with a short period cannot be late by half of it, and one with a long period cannot lose a frame:
// the target may turn too far in the gap.
TEST(SequenceFeatures, TimesBetweenFramesSuitTheSensor) {
  const auto weights = std::make_unique<gnc::NetworkWeights<gnc::Float32>>();
  torch::manual_seed(5);
  export_weights(Cnn(), Recurrent(), *weights);
  constexpr double kNominal_s = 2.7;
  for (const double period_s : {0.1, kNominal_s, 5.0}) {
    SCOPED_TRACE(period_s);
    TrainingTargets targets = make_training_targets({make_near_shoemaker()}, {Condition::kNominal});
    targets.sensor.period_s = period_s;
    constexpr int kCount = 64;
    SequenceFeatures supply(targets, *weights, 5, kCount, 2);
    const torch::Tensor periods = supply.first(kCount).hypotheses.periods;
    EXPECT_TRUE(periods.select(1, 0).eq(1.0).all().item<bool>());
    const torch::Tensor times_s = kNominal_s * periods.narrow(1, 1, kTrainingFrames - 1);
    EXPECT_GE(times_s.min().item<double>(), std::min(0.4, period_s) - 1e-4);
    EXPECT_LE(times_s.max().item<double>(), 7.0 + 1e-4);
    const torch::Tensor as_the_sensor = (times_s - period_s).abs().lt(1e-4);
    const auto regular = as_the_sensor.all(1).sum().item<std::int64_t>();
    EXPECT_GE(regular, kCount / 3);
    EXPECT_LT(regular, kCount);
    const bool has_gaps = (times_s - 2.0 * period_s).abs().lt(1e-4).any().item<bool>();
    EXPECT_EQ(has_gaps, period_s != 5.0);
  }
}

// Verifies TS-SIL-340. Twelve frames with one strength.
TEST(SequenceFeatures, ASequenceKeepsTheStrengthThatItDraws) {
  const auto weights = std::make_unique<gnc::NetworkWeights<gnc::Float32>>();
  torch::manual_seed(5);
  export_weights(Cnn(), Recurrent(), *weights);
  const auto targets_with = [](const EffectRanges& effects) {
    return make_training_targets({make_near_shoemaker()}, {Condition::kNominal}, Eigen::Matrix3d::Identity(),
                                 {effects});
  };
  const auto features = [&](const TrainingTargets& targets) {
    SequenceFeatures supply(targets, *weights, 5, 2, 2);
    return supply.first(2).hypotheses.features;
  };
  const TrainingTargets ranged = targets_with(effect_ranges_from({"dropout=0.1:0.6"}));
  const torch::Tensor drawn = features(ranged);
  const ScenarioSettings scenario =
      scenario_of(ranged, Condition::kNominal, ranged.effect_sets.front().effects, kTrainingFrames);
  for (int i = 0; i < 2; ++i) {
    const Effects fixed = make_sequence(scenario, mix(5, 0), static_cast<std::uint64_t>(i)).effects;
    EXPECT_TRUE(torch::equal(drawn[i], features(targets_with(fixed))[i])) << i;
  }
}

// Verifies TS-SIL-320, TS-SIL-330.
TEST(FrameStream, FramesAreThoseOfTheSensorAtItsRanges) {
  const TriangleMesh mesh = make_near_shoemaker();
  const TrainingTargets plain = make_training_targets({mesh}, {Condition::kNominal});
  const auto seen_by = [&](const char* name, const std::function<RangeLimits(double)>& ranges = {}) {
    return make_training_targets({mesh}, {Condition::kNominal}, Eigen::Matrix3d::Identity(), {}, {},
                                 sensor_named(name), ranges);
  };
  const TrainingTargets paper = seen_by("paper"), flash = seen_by("flash_256");
  const TrainingTargets far = seen_by("paper", [](double) { return RangeLimits{100.0, 200.0}; });
  EXPECT_EQ(view_hash(paper), view_hash(plain));
  EXPECT_NE(view_hash(flash), view_hash(plain));
  EXPECT_NE(view_hash(far), view_hash(plain));
  const torch::Tensor images = render_frames(plain, 5, 0, 4).images;
  EXPECT_TRUE(torch::equal(render_frames(paper, 5, 0, 4).images, images));
  EXPECT_FALSE(torch::equal(render_frames(flash, 5, 0, 4).images, images));
  EXPECT_FALSE(torch::equal(render_frames(far, 5, 0, 4).images, images));
}

// Verifies TS-TRN-050.
TEST(FrameStream, ListsOfConditionsHaveDifferentHashes) {
  const std::vector<Condition> nominal{Condition::kNominal}, twice{Condition::kNominal, Condition::kNominal},
      swapped{Condition::kDegraded, Condition::kNominal};
  EXPECT_EQ(conditions_hash(paper_training_conditions()),
            conditions_hash({Condition::kNominal, Condition::kDegraded}));
  EXPECT_NE(conditions_hash(paper_training_conditions()), conditions_hash(swapped));
  EXPECT_NE(conditions_hash(nominal), conditions_hash(twice));
  EXPECT_NE(conditions_hash(paper_training_conditions()), conditions_hash(all_training_conditions()));
  EXPECT_NE(conditions_hash(nominal, {effects_from({"noise=5"})}), conditions_hash(nominal));
  EXPECT_NE(conditions_hash(nominal, {effects_from({"noise=5"})}),
            conditions_hash(nominal, {effects_from({"noise=4"})}));
  EXPECT_NE(conditions_hash(nominal, {effect_ranges_from({"noise=4:5"})}),
            conditions_hash(nominal, {effect_ranges_from({"noise=3:5"})}));
  const Effects noisy = effects_from({"noise=5"});
  EXPECT_EQ(conditions_hash(nominal, {{}}), conditions_hash(nominal)) << "one set without effects is none";
  EXPECT_NE(conditions_hash(nominal, {{}, noisy}), conditions_hash(nominal, {noisy}));
  EXPECT_NE(conditions_hash(nominal, {{}, noisy}), conditions_hash(nominal, {noisy, {}}));
  EXPECT_NE(conditions_hash(nominal, {{}, {}, noisy}), conditions_hash(nominal, {{}, noisy}));
  const std::vector<Condition> all = all_training_conditions();
  EXPECT_EQ(std::count(all.begin(), all.end(), Condition::kStress), 0) << "the stress test is for tests only";
}

TEST(TrainingConditions, AreThoseOfTheWordsInTheirOrder) {
  EXPECT_EQ(training_conditions({"all"}), all_training_conditions());
  EXPECT_EQ(training_conditions({"paper"}), paper_training_conditions());
  std::vector<Condition> more = all_training_conditions();
  more.insert(more.end(), {Condition::kDegraded, Condition::kOffset});
  EXPECT_EQ(training_conditions({"all", "degraded", "offset"}), more);
  EXPECT_THROW(training_conditions({"all", "some"}), std::invalid_argument);
  const std::vector<std::string> words = training_condition_words();
  for (const std::string& word : words) EXPECT_FALSE(training_conditions({word}).empty());
  EXPECT_EQ(std::count(words.begin(), words.end(), "stress"), 0) << "the stress test is for tests only";
}

}  // namespace
}  // namespace tumblesight::sim
