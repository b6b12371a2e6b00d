#include "gnc/rcnn/hypotheses.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

#include "gnc/attitude/rotation.hpp"
#include "gnc/numerics/conversion.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kLogits = shape::kColumns;
constexpr int kErrorLogit = shape::kOutput - 1;
constexpr float kDegree = static_cast<float>(M_PI / 180.0);
const Eigen::Matrix3f kIdentity = Eigen::Matrix3f::Identity();

Eigen::Matrix3f turn(float angle_rad, const Eigen::Vector3f& axis) {
  return Eigen::AngleAxisf(angle_rad, axis.normalized()).toRotationMatrix();
}

void set_hypothesis(OutputVector<float>& output, int k, const Eigen::Matrix3f& r, float logit) {
  for (int i = 0; i < 3; ++i) {
    output[6 * k + i] = 3.0F * r(i, 0);  // lengths do not matter
    output[6 * k + 3 + i] = 0.5F * r(i, 1) + r(i, 0);
  }
  output[kLogits + k] = logit;
}

Eigen::Matrix3f single_frame(const Hypotheses<float>& hypotheses) {
  return mean_attitude<float>(hypotheses.r_lrf_trf.data(), hypotheses.probability.data(), shape::kHypotheses,
                              hypotheses.likeliest);
}

float difference(const Eigen::Matrix3f& a, const Eigen::Matrix3f& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

// Verifies TS-EST-120.
TEST(Hypotheses, AreRotatedFromTheViewIntoTheLidarFrame) {
  const Eigen::Matrix3f r_lrf_view = turn(0.15F, {0.3F, 0.0F, -1.0F});
  OutputVector<float> output{};
  std::array<Eigen::Matrix3f, shape::kHypotheses> r_view_trf;
  for (int k = 0; k < shape::kHypotheses; ++k) {
    r_view_trf[k] = turn(0.7F * static_cast<float>(k), {1.0F, static_cast<float>(k), -0.5F});
    set_hypothesis(output, k, r_view_trf[k], 0.5F * static_cast<float>(k % 3));
  }
  const Hypotheses<float> hypotheses = decode_hypotheses<float>(output, r_lrf_view);
  double sum = 0.0;
  for (int k = 0; k < shape::kHypotheses; ++k) sum += std::exp(0.5 * (k % 3));
  for (int k = 0; k < shape::kHypotheses; ++k) {
    EXPECT_LT(difference(hypotheses.r_lrf_trf[k], r_lrf_view * r_view_trf[k]), 1e-6F) << k;
    EXPECT_EQ(hypotheses.logit[k], 0.5F * static_cast<float>(k % 3));
    EXPECT_NEAR(hypotheses.probability[k], std::exp(0.5 * (k % 3)) / sum, 1e-6) << k;
  }
}

// Verifies TS-EST-120.
TEST(Hypotheses, NameTheLikeliestAndTheFirstOfEquals) {
  for (int best = 0; best < shape::kHypotheses; ++best) {
    OutputVector<float> output{};
    for (int k = 0; k < shape::kHypotheses; ++k) {
      set_hypothesis(output, k, turn(0.8F * static_cast<float>(k + 1), Eigen::Vector3f::UnitZ()),
                     k == best ? -1.0F : -2.0F);
    }
    const Hypotheses<float> hypotheses = decode_hypotheses<float>(output, kIdentity);
    EXPECT_EQ(hypotheses.likeliest, best);
    EXPECT_LT(difference(single_frame(hypotheses), hypotheses.r_lrf_trf[best]), 1e-6F);
    for (int k = best; k < shape::kHypotheses; ++k) output[kLogits + k] = 5.0F;
    EXPECT_EQ(decode_hypotheses<float>(output, kIdentity).likeliest, best);
  }
}

// Verifies TS-EST-100.
TEST(Hypotheses, MapTheErrorLogitOntoZeroToPi) {
  OutputVector<float> output{};
  for (const float logit : {-100.0F, -3.0F, 0.0F, 2.0F, 100.0F}) {
    output[kErrorLogit] = logit;
    EXPECT_NEAR(decode_hypotheses<float>(output, kIdentity).predicted_error_rad,
                M_PI / (1.0 + std::exp(-logit)), 1e-6);
  }
}

// Verifies TS-EST-100.
TEST(Hypotheses, GiveAUnitQuaternionAndABoundedErrorForAnyOutput) {
  std::mt19937 engine(5);
  std::uniform_int_distribution<std::uint32_t> bits;
  for (int i = 0; i < 20000; ++i) {
    OutputVector<float> output;
    for (float& value : output) {  // any bit pattern: NaN, infinities, subnormals, huge numbers
      const std::uint32_t pattern = bits(engine);
      std::memcpy(&value, &pattern, sizeof value);
      if (i % 2 == 0 && pattern % 5 != 0) value = 0.0F;
    }
    const Hypotheses<float> hypotheses =
        decode_hypotheses<float>(output, turn(0.1F, Eigen::Vector3f::UnitX()));
    const QuaternionQ30 q = quaternion_from_rotation(converted<Fixed>(single_frame(hypotheses)));
    ASSERT_NEAR(to_double(q).norm(), 1.0, 1e-6);
    ASSERT_GE(q[0], 0);
    ASSERT_TRUE(hypotheses.likeliest >= 0 && hypotheses.likeliest < shape::kHypotheses);
    ASSERT_TRUE(hypotheses.predicted_error_rad >= 0.0F && hypotheses.predicted_error_rad <= 3.1415928F);
    for (const float p : hypotheses.probability) ASSERT_TRUE(p >= 0.0F && p <= 1.00001F);
  }
}

// Verifies TS-EST-120.
TEST(MeanAttitude, LiesBetweenItsCandidatesByTheirWeights) {
  const Eigen::Vector3f axis(0.2F, -1.0F, 0.6F);
  const Eigen::Matrix3f base = turn(2.0F, {1.0F, 1.0F, 0.0F});
  const std::array<Eigen::Matrix3f, 2> candidates{base, turn(6.0F * kDegree, axis) * base};
  for (const float weight : {0.0F, 0.25F, 0.5F, 0.9F, 1.0F}) {
    const std::array<float, 2> weights{1.0F - weight, weight};
    for (const int anchor : {0, 1}) {
      const Eigen::Matrix3f mean = mean_attitude<float>(candidates.data(), weights.data(), 2, anchor);
      EXPECT_LT(difference(mean, turn(weight * 6.0F * kDegree, axis) * base), 1e-3F) << weight;
    }
  }
}

// Verifies TS-EST-120.
TEST(MeanAttitude, TakesCandidatesWithinTwentyDegreesOfTheAnchorOnly) {
  const Eigen::Vector3f axis(0.2F, -1.0F, 0.6F);
  for (const float angle_deg : {0.1F, 10.0F, 19.9F, 20.1F, 45.0F, 90.0F, 179.0F}) {
    const std::array<Eigen::Matrix3f, 2> candidates{kIdentity, turn(angle_deg * kDegree, axis)};
    const std::array<float, 2> weights{1.0F, 1000.0F};
    const Eigen::Matrix3f mean = mean_attitude<float>(candidates.data(), weights.data(), 2, 0);
    const Eigen::Matrix3f& expected = candidates[angle_deg < kSameAttitude_deg ? 1 : 0];
    EXPECT_LT(difference(mean, expected), 1e-3F) << angle_deg;
  }
}

TEST(MeanAttitude, DoesNotDependOnTheScaleOfTheWeights) {
  const std::array<Eigen::Matrix3f, 2> candidates{turn(1.0F, {1.0F, 2.0F, 3.0F}),
                                                  turn(1.1F, {1.0F, 2.0F, 3.0F})};
  // Down to the smallest weight that a candidate with a probability of zero can have after the correction.
  for (const float scale : {1.0F, 1e3F, 1e-3F, 3e-10F}) {
    const std::array<float, 2> weights{0.5F * scale, 0.5F * scale};
    const Eigen::Matrix3f mean = mean_attitude<float>(candidates.data(), weights.data(), 2, 0);
    EXPECT_LT(difference(mean, turn(1.05F, {1.0F, 2.0F, 3.0F})), 1e-3F) << scale;
  }
}

TEST(MeanAttitude, IsNotFiniteWhereTheAnchorIsNot) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  std::array<Eigen::Matrix3f, 3> candidates{kIdentity, kIdentity, turn(0.1F, {1.0F, 2.0F, 3.0F})};
  candidates[0](1, 0) = kNan;
  candidates[1].col(1).setConstant(kNan);
  const std::array<float, 3> weights{1.0F, 1.0F, 1.0F};
  EXPECT_FALSE(mean_attitude<float>(candidates.data(), weights.data(), 3, 0).allFinite());
  EXPECT_LT(difference(mean_attitude<float>(candidates.data(), weights.data(), 3, 2), candidates[2]), 1e-6F);
}

}  // namespace
}  // namespace tumblesight::gnc
