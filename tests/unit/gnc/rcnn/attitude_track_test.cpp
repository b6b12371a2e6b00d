#include "gnc/rcnn/attitude_track.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

#include "gnc/attitude/rotation.hpp"
#include "tests/unit/gnc/rcnn/reference_track.hpp"
#include "tests/unit/gnc/rcnn/track_frames.hpp"

namespace tumblesight::gnc {
namespace {

using Head = HeadOutput<float>;
constexpr Head kUncorrected{};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

const Eigen::Vector3d kRate = 9.0 * kDegree * Eigen::Vector3d(0.4, -0.3, 0.8).normalized();
const Eigen::Matrix3d kStartAttitude = turn(2.2, {1.0, -2.0, 0.5});
// A symmetry of the target.
const Eigen::Matrix3d kSymmetry = turn(M_PI, {0.0, 1.0, 1.0});

Head head_with(int index, float value) {
  Head head{};
  head[index] = value;
  return head;
}

// The network expects an error of less than a degree.
const Head kConfident = head_with(kErrorLogit, -6.0F);

const Motion<float>& current_motion(const AttitudeTrack<float>& track) {
  return track.motion[track.motion_model()];
}

double rate_error(const AttitudeTrack<float>& track, const Eigen::Vector3d& rate = kRate) {
  return (current_motion(track).rate_lrf.cast<double>() - rate).norm();
}

// The track of a spin at kRate from kStartAttitude after `frames` measurements without error.
AttitudeTrack<float> converged_track(int frames) {
  AttitudeTrack<float> track;
  Eigen::Matrix3d truth = kStartAttitude;
  for (int k = 0; k < frames; ++k, truth = turn(kRate) * truth)
    follow(make_frame({{truth, 1.0F}}), kUncorrected, track);
  return track;
}
Eigen::Matrix3d truth_after(int frames) {
  return turn(frames * kRate) * kStartAttitude;
}

Inertia<float> slender_body() {
  Inertia<float> inertia;
  Eigen::Matrix3f tensor_trf;
  tensor_trf << 1.0F, 0.2F, 0.0F, 0.2F, 4.0F, 0.0F, 0.0F, 0.0F, 4.5F;
  EXPECT_TRUE(make_inertia<float>(tensor_trf, inertia));
  return inertia;
}

// A tumbling target with a symmetry, measurement errors of some degrees and random outputs of the head.
// Verifies TS-NUM-090.
TEST(AttitudeTrack, FollowsTheDoubleReferenceOverSequences) {
  std::mt19937 engine(8);
  std::normal_distribution<float> normal;
  const auto random_vector = [&](float scale) {
    return Eigen::Vector3f(scale * normal(engine), scale * normal(engine), scale * normal(engine));
  };
  const Inertia<float> inertia = slender_body();
  int compared = 0, tumbling = 0, merged = 0, corrected = 0;
  for (int sequence = 0; sequence < 20; ++sequence) {
    Motion<float> truth{kStartAttitude.cast<float>(), random_vector(0.3F)};
    AttitudeTrack<float> track;
    ReferenceTrack reference(inertia.tensor_trf.cast<double>());
    for (int k = 0; k < 15; ++k, truth = propagate<float>(truth, inertia)) {
      SCOPED_TRACE(testing::Message() << sequence << ' ' << k);
      OutputVector<float> output{};
      for (int i = 0; i < shape::kHypotheses; ++i) {
        Eigen::Matrix3d r = turn(random_vector(0.03F).cast<double>()) * truth.r_lrf_trf.cast<double>();
        if (i % 3 == 1) r = r * kSymmetry;
        for (int n = 0; n < 6; ++n) output[6 * i + n] = 2.0F * static_cast<float>(r(n % 3, n / 3));
        output[shape::kColumns + i] = normal(engine);
      }
      Head head;
      for (float& value : head) value = 2.0F * normal(engine);
      head[1] = head[4] = head[7] = -9.0F;  // mostly against the symmetric alternatives
      const Eigen::Matrix3f r_lrf_view = turn(0.1, {1.0, 0.0, static_cast<double>(k % 3)}).cast<float>();

      reference.observe({output.begin(), output.end()}, r_lrf_view.cast<double>());
      reference.advance({head.begin(), head.end()});
      if (reference.smallest_margin_deg < 1e-3) break;
      ++compared;
      const TrackedAttitude<float> tracked =
          follow(decode_hypotheses<float>(output, r_lrf_view), head, track, inertia);
      for (int motion_model = 0; motion_model < kMotionModels; ++motion_model) {
        ASSERT_LT(
            (track.motion[motion_model].r_lrf_trf.cast<double>() - reference.motion[motion_model].attitude)
                .norm(),
            2e-5);
        ASSERT_LT(
            (track.motion[motion_model].rate_lrf.cast<double>() - reference.motion[motion_model].rate).norm(),
            2e-5);
        ASSERT_NEAR(track.log_likelihood[motion_model], reference.log_likelihood[motion_model], 5e-3);
      }
      if (reference.margin() > 0.01) {  // closer than that, rounding decides
        ASSERT_EQ(track.motion_model(), reference.motion_model());
      }
      ASSERT_EQ(tracked.r_lrf_trf, current_motion(track).r_lrf_trf);
      ASSERT_NEAR(tracked.predicted_error_rad, reference.error_rad, 1e-6);
    }
    tumbling += reference.motion_model() > 0 ? 1 : 0;
    merged += reference.means_taken;
    corrected += reference.rates_corrected;
  }
  EXPECT_GT(compared, 250) << "of 300 frames";
  EXPECT_GT(tumbling, 5);
  EXPECT_GT(merged, 300);
  EXPECT_GT(corrected, 300);
}

TEST(AttitudeTrack, StartsWithTheLikeliestHypothesisAtRest) {
  const Hypotheses<float> frame = make_frame({{kStartAttitude, 0.6F}, {kStartAttitude * kSymmetry, 0.4F}});
  const Prediction<float> prediction =
      predict<float>(AttitudeTrack<float>{}, motion_models<float>(Inertia<float>{}), frame);
  for (const Motion<float>& motion : prediction.motion) {
    EXPECT_EQ(motion.r_lrf_trf, frame.r_lrf_trf[0]);
    EXPECT_EQ(motion.rate_lrf.norm(), 0.0F);
  }
  AttitudeTrack<float> track;
  const TrackedAttitude<float> tracked =
      advance<float>(frame, prediction, head_with(kErrorLogit, -3.0F), track);
  EXPECT_LT(angle_between(tracked.r_lrf_trf, kStartAttitude), 1e-6);
  EXPECT_NEAR(tracked.predicted_error_rad, M_PI / (1.0 + std::exp(3.0)), 1e-6);
  EXPECT_EQ(track.frames, 1U);
  EXPECT_EQ(current_motion(track).rate_lrf.norm(), 0.0F);
}

TEST(AttitudeTrack, GivesTheLstmTheHypothesesRelativeToThePrediction) {
  const Eigen::Matrix3d predicted = turn(0.7, {1.0, 1.0, 0.0});
  const Hypotheses<float> frame = make_frame({{kStartAttitude, 0.75F}, {kStartAttitude * kSymmetry, 0.25F}});
  Features<Float32> features;
  for (std::size_t i = 0; i < features.size(); ++i) features[i] = static_cast<float>(i);
  LstmInput<Float32> input;
  fill_lstm_input<Float32>(features, frame, predicted.cast<float>(), input);
  EXPECT_TRUE(std::equal(features.begin(), features.end(), input.begin()));
  for (int k = 0; k < shape::kHypotheses; ++k) {
    const Eigen::Matrix3d relative = predicted.transpose() * frame.r_lrf_trf[k].cast<double>();
    for (int i = 0; i < 6; ++i) {
      EXPECT_NEAR(input[shape::kDense2 + 6 * k + i], relative(i % 3, i / 3), 1e-6) << k << ' ' << i;
    }
    EXPECT_EQ(input[shape::kDense2 + shape::kColumns + k], frame.probability[k]);
  }
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(input[shape::kLstmInput - 6 + i], predicted(i % 3, i / 3), 1e-6);
}

TEST(AttitudeTrack, ContinuesAtItsRateIfTheHeadSelectsThePrediction) {
  AttitudeTrack<float> track = converged_track(12);
  const Eigen::Matrix3d wrong = turn(1.0, {0.0, 0.0, 1.0}) * truth_after(12);
  const TrackedAttitude<float> tracked =
      follow(make_frame({{wrong, 1.0F}}), head_with(kPredicted, 50.0F), track);
  EXPECT_LT(angle_between(tracked.r_lrf_trf, truth_after(12)), 1e-4);
  EXPECT_LT(rate_error(track), 1e-4);
}

TEST(AttitudeTrack, UsesTheAnchorThatTheHeadSelects) {
  const Eigen::Matrix3d other = kStartAttitude * kSymmetry;
  for (const int anchor : {0, 1, 5}) {
    AttitudeTrack<float> track;
    const Hypotheses<float> frame = make_frame({{kStartAttitude, 0.6F}, {other, 0.4F}});
    const TrackedAttitude<float> tracked = follow(frame, head_with(anchor, 60.0F), track);
    EXPECT_LT(angle_between(tracked.r_lrf_trf, frame.r_lrf_trf[anchor].cast<double>()), 1e-6) << anchor;
  }
}

TEST(AttitudeTrack, WeighsCandidatesByTheHeadsCorrectionUpToItsBound) {
  const Eigen::Matrix3d near = turn(6.0 * kDegree, {0.3, 1.0, 0.2}) * kStartAttitude;
  const auto distance_to_start = [&](float correction) {
    AttitudeTrack<float> track;
    return angle_between(follow(make_frame({{kStartAttitude, 0.5F}, {near, 0.5F}}),
                                head_with(kWeightCorrections + 1, correction), track)
                             .r_lrf_trf,
                         kStartAttitude);
  };
  EXPECT_NEAR(distance_to_start(0.0F), 3.0 * kDegree, 2e-3);
  EXPECT_NEAR(distance_to_start(std::log(2.0F)), 4.0 * kDegree, 2e-3);
  EXPECT_NEAR(distance_to_start(-8.0F), 6.0 * kDegree / (1.0 + std::exp(8.0)), 2e-5);
  EXPECT_EQ(distance_to_start(-1000.0F), distance_to_start(-8.0F));
  EXPECT_EQ(distance_to_start(1000.0F), distance_to_start(8.0F));
}

// Verifies TS-EST-130.
TEST(AttitudeTrack, IgnoresAlternativesWhateverTheirProbability) {
  const Eigen::Matrix3d truth = truth_after(12);
  AttitudeTrack<float> alone = converged_track(12);
  const TrackedAttitude<float> expected = follow(make_frame({{truth, 0.3F}}), head_with(0, 50.0F), alone);
  for (const double away_deg : {21.0, 60.0, 120.0, 180.0}) {
    AttitudeTrack<float> track = converged_track(12);
    const Eigen::Matrix3d alternative = turn(away_deg * kDegree, {0.1, 1.0, -0.4}) * truth;
    const Hypotheses<float> frame = make_frame({{truth, 0.3F}, {alternative, 0.7F}});
    const TrackedAttitude<float> tracked = follow(frame, head_with(0, 50.0F), track);
    EXPECT_LT((tracked.r_lrf_trf - expected.r_lrf_trf).norm(), 1e-6F) << away_deg;
  }
}

// Verifies TS-EST-130.
TEST(AttitudeTrack, KeepsItsRateWhenItChangesToASymmetricAttitude) {
  AttitudeTrack<float> track = converged_track(12);
  follow(make_frame({{truth_after(12) * kSymmetry, 1.0F}}), kUncorrected, track);
  EXPECT_LT(angle_between(current_motion(track).r_lrf_trf, truth_after(12) * kSymmetry), 1e-5);
  EXPECT_LT(rate_error(track), 1e-4);
  const Prediction<float> next =
      predict<float>(track, motion_models<float>(Inertia<float>{}), make_frame({{kStartAttitude, 1.0F}}));
  EXPECT_LT(angle_between(next.r_lrf_trf(), truth_after(13) * kSymmetry), 2e-4);
}

// Verifies TS-EST-130.
TEST(AttitudeTrack, StaysOnItsBranchIfTheHeadSelectsThePrediction) {
  AttitudeTrack<float> track;
  for (int k = 0; k < 15; ++k) {
    // The likelier hypothesis alternates between the truth and its symmetric counterpart.
    const float probability = k % 2 == 0 ? 0.6F : 0.4F;
    const Hypotheses<float> frame =
        make_frame({{truth_after(k), probability}, {truth_after(k) * kSymmetry, 1.0F - probability}});
    const Head head = k == 0 ? kUncorrected : head_with(kPredicted, 50.0F);
    EXPECT_LT(angle_between(follow(frame, head, track).r_lrf_trf, truth_after(k)), 0.05 * kDegree) << k;
  }
  EXPECT_LT(rate_error(track), 1e-3);
}

QuaternionQ30 q30(const Eigen::Quaterniond& q) {
  const auto part = [](double x) { return static_cast<std::int32_t>(std::lround(std::ldexp(x, 30))); };
  return {part(q.w()), part(q.x()), part(q.y()), part(q.z())};
}

FrameInterval interval_of(double periods) {
  FrameInterval interval;
  interval.elapsed_ns = std::llround(periods * kNominalPeriod_ns);
  return interval;
}

// Verifies TS-EST-182. The target turns by up to 140 degrees from frame to frame.
TEST(AttitudeTrack, FindsTheRateAtAnyTimeBetweenFrames) {
  for (const double periods : {0.074, 0.37, 0.5, 1.0, 1.7, 2.0, 2.59}) {
    for (const double rate_deg : {0.0, 9.0, 54.0}) {
      const Eigen::Vector3d rate = rate_deg * kDegree * kRate.normalized();
      AttitudeTrack<float> track;
      Eigen::Matrix3d truth = kStartAttitude;
      for (int k = 0; k < 12; ++k, truth = turn(periods * rate) * truth)
        follow(make_frame({{truth, 1.0F}}), kUncorrected, track, {}, interval_of(periods));
      EXPECT_LT(rate_error(track, rate), 0.2 * kDegree) << periods << ' ' << rate_deg;
    }
  }
}

// A frame of the estimator when the rate of the track is not known, without the network.
bool follow_without_rate(const Hypotheses<float>& frame, const FrameInterval& interval,
                         AttitudeTrack<float>& track) {
  Prediction<float> prediction =
      predict<float>(track, motion_models<float>(Inertia<float>{}), frame, interval);
  const bool confirmed = keep_confirmed<float>(frame, interval, prediction, track);
  EXPECT_TRUE(confirmed || !prediction.has_track);
  advance<float>(frame, prediction, kUncorrected, track);
  return confirmed;
}

// Verifies TS-EST-182. 10 s between frames. The rate is the slowest one that explains the attitudes: the true
// one up to 15 degrees/s, and beyond it one that leads to the same attitudes.
TEST(AttitudeTrack, FollowsASpinWithoutKnowingItsRate) {
  const double periods = 10.0 / 2.7;
  for (const double rate_deg_s : {0.0, 1.0, 6.0, 14.5, 22.0, 35.0}) {
    const Eigen::Vector3d rate = 2.7 * rate_deg_s * kDegree * kRate.normalized();
    const double others = rate_deg_s > 15.0 ? 2.7 * 36.0 * kDegree : 0.0;
    AttitudeTrack<float> track;
    Eigen::Matrix3d truth = kStartAttitude;
    for (int k = 0; k < 12; ++k, truth = turn(periods * rate) * truth) {
      const bool confirmed = follow_without_rate(make_frame({{truth, 1.0F}}), interval_of(periods), track);
      EXPECT_LT(angle_between(current_motion(track).r_lrf_trf, truth), 0.5 * kDegree) << rate_deg_s << k;
      EXPECT_TRUE(confirmed || k < 2) << rate_deg_s << ' ' << k;
    }
    EXPECT_LT(rate_error(track, rate - others * kRate.normalized()), 0.2 * kDegree) << rate_deg_s;
  }
}

// Verifies TS-EST-182, TS-EST-184. A prediction that the hypotheses do not confirm has no effect.
TEST(AttitudeTrack, AWrongRateDoesNotSpoilTheAttitude) {
  const Eigen::Matrix3d other = kStartAttitude * turn(std::acos(-1.0), {0.0, 0.0, 1.0});
  const Hypotheses<float> frame = make_frame({{kStartAttitude, 0.6F}, {other, 0.4F}});
  AttitudeTrack<float> alone, track = converged_track(12);
  FrameInterval interval = interval_of(4.0);
  interval.q_now_last = q30(Eigen::Quaterniond(turn(0.4, {0.0, 0.0, 1.0})));
  const Eigen::Matrix3d last =
      turn(0.4, {0.0, 0.0, 1.0}) * Eigen::Matrix3d(current_motion(track).r_lrf_trf.cast<double>());
  EXPECT_FALSE(follow_without_rate(frame, interval, track));
  advance<float>(frame, predict<float>(alone, motion_models<float>(Inertia<float>{}), frame, {}),
                 kUncorrected, alone);
  EXPECT_EQ(current_motion(track).r_lrf_trf, current_motion(alone).r_lrf_trf);
  EXPECT_EQ(track.frames, 1U);
  const Eigen::Vector3d rate = current_motion(track).rate_lrf.cast<double>();
  EXPECT_LT(angle_between(Eigen::Matrix3d(turn(4.0 * rate) * last), kStartAttitude), 0.5 * kDegree)
      << "the rate from the last attitude";
}

TEST(AttitudeTrack, BeginsAgainAtItsLastAttitude) {
  AttitudeTrack<float> track;
  track.forget_rate(true);
  EXPECT_EQ(track.frames, 0U) << "before the first frame there is nothing to forget";
  track = converged_track(12);
  const Eigen::Matrix3f last = current_motion(track).r_lrf_trf;
  track.forget_rate(false);
  EXPECT_EQ(track.frames, 12U);
  EXPECT_LT(rate_error(track), 1e-3);
  track.forget_rate(true);
  EXPECT_EQ(track.frames, 1U);
  for (const Motion<float>& motion : track.motion) {
    EXPECT_EQ(motion.r_lrf_trf, last);
    EXPECT_EQ(motion.rate_lrf.norm(), 0.0F);
  }
}

// Verifies TS-EST-182.
TEST(AttitudeTrack, CoastsOverGapsOfAnyLength) {
  for (const double gap : {0.3, 1.5, 2.0, 3.0, 7.0, 8.0}) {
    AttitudeTrack<float> track = converged_track(12);
    const Eigen::Matrix3d truth = turn((11.0 + gap) * kRate) * kStartAttitude;
    const Prediction<float> prediction =
        predict<float>(track, motion_models<float>(Inertia<float>{}), make_frame({{kStartAttitude, 1.0F}}),
                       interval_of(gap));
    EXPECT_LT(angle_between(prediction.r_lrf_trf(), truth), 1e-3) << gap;
    follow(make_frame({{truth, 1.0F}}), kUncorrected, track, {}, interval_of(gap));
    EXPECT_LT(rate_error(track), 1e-3) << gap;
  }
}

// Verifies TS-EST-182.
TEST(AttitudeTrack, FollowsIrregularFrames) {
  std::mt19937 engine(8);
  std::uniform_real_distribution<double> any(0.1, 2.2);
  AttitudeTrack<float> track;
  Eigen::Matrix3d truth = kStartAttitude;
  follow(make_frame({{truth, 1.0F}}), kUncorrected, track);
  for (int k = 0; k < 40; ++k) {
    const double periods = any(engine);
    truth = turn(periods * 4.0 * kRate) * truth;
    follow(make_frame({{truth, 1.0F}}), kUncorrected, track, {}, interval_of(periods));
    if (k > 10) {
      EXPECT_LT(rate_error(track, 4.0 * kRate), 0.1 * kDegree) << k;
    }
  }
}

// Verifies TS-EST-184. The LRF turns at 13 degrees per period about another axis than the target.
TEST(AttitudeTrack, FollowsASpinFromATurningChaser) {
  const Eigen::Vector3d chaser_rate = 13.0 * kDegree * Eigen::Vector3d(0.1, 0.9, -0.4).normalized();
  AttitudeTrack<float> track;
  double time = 0.0;
  const auto lrf = [&] { return turn(time * chaser_rate); };  // v_inertial = lrf v_lrf
  for (int k = 0; k < 20; ++k) {
    const double periods = 0.4 + 0.1 * (k % 9);
    const Eigen::Matrix3d before = lrf();
    time += periods;
    FrameInterval interval = interval_of(periods);
    interval.q_now_last = q30(Eigen::Quaterniond(lrf().transpose() * before));
    const Eigen::Matrix3d truth = lrf().transpose() * turn(time * kRate) * kStartAttitude;
    follow(make_frame({{truth, 1.0F}}), kUncorrected, track, {}, interval);
    if (k > 3) {
      EXPECT_LT(rate_error(track, lrf().transpose() * kRate), 0.1 * kDegree) << k;
    }
  }
}

// Verifies TS-EST-140.
TEST(AttitudeTrack, FindsTheMotionModel) {
  const MotionModels<float> motion_models = gnc::motion_models<float>(slender_body());
  for (int motion_model = 0; motion_model < kMotionModels; ++motion_model) {
    SCOPED_TRACE(motion_model);
    Motion<float> truth{kStartAttitude.cast<float>(),
                        (20.0 * kDegree * Eigen::Vector3d(0.4, -0.3, 0.8).normalized()).cast<float>()};
    AttitudeTrack<float> track;
    for (int k = 0; k < 12; ++k, truth = propagate<float>(truth, motion_models[motion_model])) {
      const Eigen::Matrix3d exact = truth.r_lrf_trf.cast<double>();
      const TrackedAttitude<float> tracked =
          follow(make_frame({{exact, 1.0F}}), kConfident, track, slender_body());
      if (k > 8) {
        EXPECT_LT(angle_between(tracked.r_lrf_trf, exact), 1.0 * kDegree) << k;
      }
    }
    EXPECT_EQ(track.motion_model(), motion_model);
    EXPECT_EQ(predict<float>(track, motion_models, make_frame({{kStartAttitude, 1.0F}})).motion_model,
              motion_model);
    EXPECT_EQ(track.log_likelihood[motion_model], 0.0F);
    EXPECT_LT(track.log_likelihood[motion_model == kSpinModel ? kTumbleModel : kSpinModel], -2.0F);
  }
}

TEST(AttitudeTrack, FindsNoMotionModelFromUncertainMeasurements) {
  const Inertia<float> inertia = slender_body();
  Motion<float> truth{kStartAttitude.cast<float>(), {0.1F, -0.08F, 0.2F}};
  AttitudeTrack<float> track;
  for (int k = 0; k < 12; ++k, truth = propagate<float>(truth, inertia)) {
    follow(make_frame({{truth.r_lrf_trf.cast<double>(), 1.0F}}), head_with(kErrorLogit, 0.0F), track,
           inertia);
  }
  EXPECT_EQ(track.motion_model(), kSpinModel)
      << "an expected error of 90 degrees does not distinguish the motion models";
}

// Verifies TS-EST-170.
TEST(AttitudeTrack, StartsOverFromADamagedTrack) {
  for (int damage = 0; damage < 5; ++damage) {
    SCOPED_TRACE(damage);
    AttitudeTrack<float> track = converged_track(12);
    if (damage == 0) track.motion[0].r_lrf_trf(1, 2) = kNan;
    if (damage == 1) track.motion[1].r_lrf_trf.setConstant(std::numeric_limits<float>::infinity());
    if (damage == 2) track.motion[0].rate_lrf.x() = kNan;
    if (damage == 3) track.motion[1].rate_lrf.y() = -std::numeric_limits<float>::infinity();
    if (damage == 4) track.log_likelihood[3] = kNan;
    AttitudeTrack<float> fresh;
    for (int k = 12; k < 16; ++k) {
      const Hypotheses<float> frame = make_frame({{truth_after(k), 1.0F}});
      const TrackedAttitude<float> tracked = follow(frame, kUncorrected, track);
      const TrackedAttitude<float> expected = follow(frame, kUncorrected, fresh);
      EXPECT_EQ(tracked.r_lrf_trf, expected.r_lrf_trf);
      EXPECT_EQ(current_motion(track).rate_lrf, current_motion(fresh).rate_lrf);
      EXPECT_EQ(track.frames, fresh.frames);
    }
  }
}

TEST(AttitudeTrack, LosesOneFrameToANonFiniteAnchor) {
  AttitudeTrack<float> track = converged_track(12);
  Hypotheses<float> damaged = make_frame({{truth_after(12), 1.0F}});
  damaged.r_lrf_trf[0](0, 0) = kNan;
  EXPECT_FALSE(follow(damaged, kUncorrected, track).r_lrf_trf.allFinite());
  AttitudeTrack<float> fresh;
  for (int k = 13; k < 16; ++k) {
    const Hypotheses<float> frame = make_frame({{truth_after(k), 1.0F}});
    EXPECT_EQ(follow(frame, kUncorrected, track).r_lrf_trf, follow(frame, kUncorrected, fresh).r_lrf_trf);
  }
}

TEST(AttitudeTrack, IgnoresANonFiniteHypothesisThatIsNotTheAnchor) {
  AttitudeTrack<float> track = converged_track(12);
  Hypotheses<float> damaged = make_frame({{truth_after(12), 1.0F}});
  damaged.r_lrf_trf[3].setConstant(kNan);
  EXPECT_LT(angle_between(follow(damaged, kUncorrected, track).r_lrf_trf, truth_after(12)), 1e-4);
  EXPECT_LT(rate_error(track), 1e-4);
}

// Verifies TS-EST-100, TS-EST-170.
TEST(AttitudeTrack, GivesUnitQuaternionsForAnyInput) {
  std::mt19937 engine(6);
  std::uniform_int_distribution<std::uint32_t> bits;
  const auto damage = [&](float* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t pattern = bits(engine);
      if (pattern % 7 == 0) std::memcpy(&values[i], &pattern, sizeof(float));
    }
  };
  for (int i = 0; i < 5000; ++i) {
    AttitudeTrack<float> track = converged_track(static_cast<int>(bits(engine) % 4));
    Hypotheses<float> frame = make_frame({{truth_after(3), 0.7F}, {kStartAttitude, 0.3F}});
    Head head{};
    damage(head.data(), head.size());
    if (i % 2 == 0) damage(frame.r_lrf_trf[i % 8].data(), 9);
    if (i % 3 == 0) damage(frame.logit.data(), frame.logit.size());
    if (i % 5 == 0) damage(track.motion[i % kMotionModels].r_lrf_trf.data(), 9);
    if (i % 7 == 0) damage(track.motion[i % kMotionModels].rate_lrf.data(), 3);
    for (int k = 0; k < 3; ++k) {
      const TrackedAttitude<float> tracked = follow(frame, head, track);
      ASSERT_NEAR(to_double(quaternion_from_rotation(converted<Fixed>(tracked.r_lrf_trf))).norm(), 1.0, 1e-6);
      ASSERT_TRUE(tracked.predicted_error_rad >= 0.0F && tracked.predicted_error_rad <= 3.1415928F);
      for (const float value : track.log_likelihood) ASSERT_TRUE(value >= -6.0F && value <= 0.0F) << value;
    }
  }
}

// The head may select the prediction while one motion model has lost the target. Its result then equals its
// prediction, which must not count as a match.
// Verifies TS-EST-140.
TEST(AttitudeTrack, AMotionModelThatLostTheTargetDoesNotWinAndFindsItAgain) {
  const Inertia<float> inertia = slender_body();
  Motion<float> truth{kStartAttitude.cast<float>(),
                      (20.0 * kDegree * Eigen::Vector3d(0.4, -0.3, 0.8).normalized()).cast<float>()};
  AttitudeTrack<float> track;
  std::mt19937 engine(9);
  std::normal_distribution<double> normal(0.0, 1.5 * kDegree);
  for (int k = 0; k < 40; ++k, truth = propagate<float>(truth, motion_models<float>(inertia)[kSpinModel])) {
    const Eigen::Matrix3d exact = truth.r_lrf_trf.cast<double>();
    const double x = normal(engine);
    const double y = normal(engine);
    const double z = normal(engine);
    const Eigen::Matrix3d seen = turn({x, y, z}) * exact;
    const Head head = k < 6 ? kUncorrected : head_with(kPredicted, 50.0F);
    const TrackedAttitude<float> tracked = follow(make_frame({{seen, 1.0F}}), head, track, inertia);
    EXPECT_LT(angle_between(tracked.r_lrf_trf, exact), 6.0 * kDegree) << "frame " << k;
    for (const Motion<float>& motion : track.motion) {
      EXPECT_LT(angle_between(motion.r_lrf_trf, exact), 60.0 * kDegree) << "frame " << k;
    }
  }
  EXPECT_EQ(track.motion_model(), kSpinModel);
}

// Verifies TS-EST-170.
TEST(AttitudeTrack, AStateWithoutARotationIsReset) {
  AttitudeTrack<float> track;
  track.frames = 5;
  track.motion[0].r_lrf_trf.setZero();
  const Eigen::Matrix3d attitude = kStartAttitude;
  const TrackedAttitude<float> tracked =
      follow(make_frame({{attitude, 1.0F}}), head_with(kPredicted, 50.0F), track, slender_body());
  EXPECT_LT(angle_between(tracked.r_lrf_trf, attitude), 0.1 * kDegree);
  EXPECT_EQ(track.frames, 1U) << "a new track";
}

}  // namespace
}  // namespace tumblesight::gnc
