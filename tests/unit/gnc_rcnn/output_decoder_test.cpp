#include "gnc/rcnn/output_decoder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

namespace tumblesight::gnc {
namespace {

constexpr int kLogits = shape::kColumns;
constexpr int kErrorLogit = shape::kOutput - 1;

void set_hypothesis(OutputVector& output, int k, const Eigen::Quaternionf& q, float logit) {
  const Eigen::Matrix3f r = q.toRotationMatrix();
  for (int i = 0; i < 3; ++i) {
    output[6 * k + i] = 3.0F * r(i, 0);  // lengths do not matter
    output[6 * k + 3 + i] = 0.5F * r(i, 1) + r(i, 0);
  }
  output[kLogits + k] = logit;
}

TEST(DecodeOutput, TakesTheHypothesisWithTheLargestLogit) {
  for (int best = 0; best < shape::kHypotheses; ++best) {
    OutputVector output{};
    for (int k = 0; k < shape::kHypotheses; ++k) {
      const Eigen::Quaternionf q(
          Eigen::AngleAxisf(0.3F * static_cast<float>(k + 1), Eigen::Vector3f::UnitZ()));
      set_hypothesis(output, k, q, k == best ? -1.0F : -2.0F);
    }
    const DecodedAttitude decoded = decode_output(output);
    EXPECT_NEAR(decoded.q_lrf_trf.z(), std::sin(0.15 * (best + 1)), 1e-6) << best;
    EXPECT_NEAR(decoded.q_lrf_trf.w(), std::cos(0.15 * (best + 1)), 1e-6) << best;
  }
}

TEST(DecodeOutput, TakesTheFirstOfEqualLogits) {
  OutputVector output{};
  for (int k = 0; k < shape::kHypotheses; ++k) {
    const float angle = 0.2F * static_cast<float>(k + 1);
    set_hypothesis(output, k, Eigen::Quaternionf(Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitX())),
                   k >= 3 ? 5.0F : 0.0F);
  }
  EXPECT_NEAR(decode_output(output).q_lrf_trf.x(), std::sin(0.4), 1e-6);
}

TEST(DecodeOutput, MapsTheErrorLogitOntoZeroToPi) {
  OutputVector output{};
  for (const float logit : {-100.0F, -3.0F, 0.0F, 2.0F, 100.0F}) {
    output[kErrorLogit] = logit;
    EXPECT_NEAR(decode_output(output).predicted_error_rad, M_PI / (1.0 + std::exp(-logit)), 1e-6);
  }
}

TEST(DecodeOutput, IsAlwaysAUnitQuaternionWithABoundedError) {
  std::mt19937 engine(5);
  std::uniform_int_distribution<std::uint32_t> bits;
  for (int i = 0; i < 20000; ++i) {
    OutputVector output;
    for (float& value : output) {  // any bit pattern: NaN, infinities, subnormals, huge numbers
      const std::uint32_t pattern = bits(engine);
      std::memcpy(&value, &pattern, sizeof value);
      if (i % 2 == 0 && pattern % 5 != 0) value = 0.0F;
    }
    const DecodedAttitude decoded = decode_output(output);
    ASSERT_NEAR(decoded.q_lrf_trf.cast<double>().norm(), 1.0, 1e-6);
    ASSERT_GE(decoded.q_lrf_trf.w(), 0.0F);
    ASSERT_TRUE(decoded.predicted_error_rad >= 0.0F && decoded.predicted_error_rad <= 3.1415928F);
  }
}

TEST(DecodeOutput, DoesNotTrustANonFiniteHypothesis) {
  OutputVector output{};
  output[kErrorLogit] = -100.0F;
  output[2] = std::numeric_limits<float>::quiet_NaN();
  const DecodedAttitude decoded = decode_output(output);
  EXPECT_EQ(decoded.q_lrf_trf.w(), 1.0F);
  EXPECT_FLOAT_EQ(decoded.predicted_error_rad, static_cast<float>(M_PI));
}

}  // namespace
}  // namespace tumblesight::gnc
