#include "gnc/estimation/covariance.hpp"

#include "gnc/estimation/attitude_estimator.hpp"
#include "gnc/numerics/division.hpp"
#include "gnc/rcnn/attitude_track.hpp"

namespace tumblesight::gnc {
namespace {

CovarianceE8 isotropic(std::int32_t variance) {
  return {variance, 0, 0, variance, 0, variance};
}

// Rounded up, and at least 1, because a filter cannot use a singular covariance.
std::int64_t variance_of(std::int64_t dividend, std::int64_t divisor) {
  return max<std::int64_t>(divide(dividend + divisor - 1, divisor), 1);
}

std::int64_t attitude_variance(std::uint32_t predicted_error_urad) {
  constexpr std::int64_t kPiOver8_e6 = 392'699;
  const std::int64_t error_urad = min<std::int64_t>(predicted_error_urad, kPi_urad);
  return variance_of(error_urad * error_urad * kPiOver8_e6, 10'000'000'000);
}

}  // namespace

CovarianceE8 attitude_covariance(std::uint32_t predicted_error_urad) {
  return isotropic(static_cast<std::int32_t>(attitude_variance(predicted_error_urad)));
}

CovarianceE8 rate_covariance(std::uint32_t predicted_error_urad, std::uint32_t frames_since_reset,
                             std::int64_t elapsed_ns) {
  if (frames_since_reset < 2) return isotropic(kUnknownRateVarianceE8);
  constexpr std::int64_t kMostFrames = 10;
  const std::int64_t frames = min<std::int64_t>(frames_since_reset, kMostFrames);
  const std::int64_t interval_ms =
      clamp<std::int64_t>(elapsed_ns, kShortestInterval_ns, kNominalPeriod_ns) / 1'000'000;
  const std::int64_t divisor = (frames - 1) * (2 * frames - 1) * interval_ms * interval_ms;
  const std::int64_t variance = variance_of(attitude_variance(predicted_error_urad) * 6'000'000, divisor);
  return isotropic(static_cast<std::int32_t>(min<std::int64_t>(variance, kUnknownRateVarianceE8)));
}

}  // namespace tumblesight::gnc
