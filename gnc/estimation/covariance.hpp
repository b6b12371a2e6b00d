// Covariances of attitude and angular rate, estimated from the expected error. Elements of the symmetric
// matrix in the order xx, xy, xz, yy, yz, zz, in the LRF, in units of 1e-8 rad^2 or 1e-8 rad^2/s^2, rounded
// up. A variance is never 0.
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::gnc {

using CovarianceE8 = std::array<std::int32_t, 6>;

// The network expects one angle. An error that is normally distributed and equal about all axes has this mean
// angle if its variance about each axis is pi / 8 times the square of the angle.
CovarianceE8 attitude_covariance(std::uint32_t predicted_error_urad);

// Rates and attitudes come from a fit of a straight line to the last frames, at most 10, at equal intervals:
// with k frames the variance of the rate is 6 / ((k - 1) (2 k - 1)) times that of the attitude over the
// square of the interval. The interval is the last one, at most the nominal one: one long interval does not
// improve the rate, which the gains for nominal intervals give. At most kUnknownRateVariance, which is that
// of the first frame.
inline constexpr std::int32_t kUnknownRateVarianceE8 = 50'000'000;  // (40 degrees/s)^2
CovarianceE8 rate_covariance(std::uint32_t predicted_error_urad, std::uint32_t frames_since_reset,
                             std::int64_t elapsed_ns);

}  // namespace tumblesight::gnc
