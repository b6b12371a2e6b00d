#include "gnc/estimation/expected_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/test_models.hpp"

namespace tumblesight::gnc {
namespace {

struct Evidence {
  double network_rad, misfit, innovation_rad, second_share;
};

ErrorEvidence fixed(const Evidence& evidence) {
  const double share = evidence.network_rad / M_PI;
  ErrorEvidence made;
  made.network_error_rad = Fixed(evidence.network_rad);
  made.network_logit = Fixed(std::log(share / (1.0 - share)));
  made.misfit = static_cast<std::uint32_t>(std::lround(65536.0 * evidence.misfit));
  made.innovation_squared = Fixed(2.0 - 2.0 * std::cos(evidence.innovation_rad));
  made.second_share = Fixed(evidence.second_share);
  return made;
}

double value_of(Fixed value) {
  return std::ldexp(value.raw(), -24);
}

double logit(const Evidence& evidence) {
  return std::log(evidence.network_rad / (M_PI - evidence.network_rad));
}
double innovation(const Evidence& evidence) {
  return std::min(1.0, (1.0 - std::cos(evidence.innovation_rad)) / (1.0 - std::cos(M_PI / 6.0)));
}
double blended(double right_rad, double sum) {
  return right_rad + (1.84 - right_rad) / (1.0 + std::exp(-sum));
}

template <class Function>
void for_each_evidence(Function function) {
  for (const double network_rad : {0.003, 0.02, 0.5, 3.1})
    for (const double misfit : {0.0, 0.3, 0.6, 2.125})
      for (const double innovation_rad : {0.0, 0.2, 0.5, 0.6, M_PI})
        for (const double second_share : {0.0, 0.4, 1.0})
          function(Evidence{network_rad, misfit, innovation_rad, second_share});
}

// Verifies TS-EST-192. docs/numerics.md, in double precision.
TEST(ExpectedError, WithoutAPoseIsThatOfNetworkAndFrame) {
  for_each_evidence([](const Evidence& e) {
    const double sum = 0.82 * logit(e) + 13.0 * e.misfit + 1.6 * innovation(e) + 2.3 * e.second_share - 5.5;
    EXPECT_NEAR(value_of(expected_error_rad(fixed(e))), blended(e.network_rad, sum), 1e-4)
        << e.network_rad << ' ' << e.misfit << ' ' << e.innovation_rad << ' ' << e.second_share;
  });
}

// Verifies TS-EST-192. Everything that a pose can say.
TEST(ExpectedError, WithAPoseGoesByItsDistanceAndWhatSpeaksAgainstIt) {
  for_each_evidence([&](const Evidence& e) {
    for (unsigned bits = 0; bits < 16; ++bits) {
      ErrorEvidence evidence = fixed(e);
      evidence.has_pose = true;
      evidence.ranges_disagree = (bits & 1) != 0;
      evidence.silhouette_disagrees = (bits & 2) != 0;
      evidence.lacks_motion = (bits & 4) != 0;
      const bool far = evidence.is_far = (bits & 8) != 0;
      evidence.pose_error_rad = Fixed(0.03);
      double sum = 0.84 * logit(e) + 9.1 * e.misfit + 0.77 * innovation(e) + 1.6 * e.second_share - 5.62;
      if (evidence.lacks_motion && !far) sum += 2.33;
      if (evidence.silhouette_disagrees && !far) sum += 0.56;
      if (far) sum += 3.64;
      if (far && !evidence.ranges_disagree && !evidence.silhouette_disagrees) sum += 1.32;
      EXPECT_NEAR(value_of(expected_error_rad(evidence)), blended(far ? e.network_rad : 0.03, sum), 1e-4)
          << bits << ' ' << e.network_rad << ' ' << e.misfit;
    }
  });
}

// Whatever a damaged network or state says.
TEST(ExpectedError, IsNeverAboveHalfATurn) {
  for (const double extreme : {-128.0, 128.0}) {
    for (const bool has_pose : {false, true}) {
      ErrorEvidence evidence;
      evidence.network_error_rad = Fixed(M_PI);
      evidence.network_logit = evidence.innovation_squared = Fixed(extreme);
      evidence.misfit = 139'264;
      evidence.second_share = Fixed(1.0);
      evidence.has_pose = has_pose;
      evidence.pose_error_rad = Fixed(M_PI);
      const Fixed found = expected_error_rad(evidence);
      EXPECT_GT(found, Fixed(1.8));
      EXPECT_LT(found, Fixed(3.1416));
    }
  }
}

}  // namespace
}  // namespace tumblesight::gnc
