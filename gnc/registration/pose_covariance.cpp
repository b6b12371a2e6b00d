#include "gnc/registration/pose_covariance.hpp"

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"
#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {
namespace {

// Standard deviations that no number of frames undercuts [urad, urad/s, um, um/s].
constexpr std::array<std::int64_t, 4> kFloor{525, 60, 2000, 300};

// By which the inverse information is multiplied: kPerSquare times the square of what the poses disagree by.
// Where they disagree more, more of it is an error of the mesh, which they share. Few poses say little about
// that: kUsual_q8 counts as much as kUsualPoses of them, and the result is larger the fewer there are. Fitted
// to three targets under the paper's conditions.
constexpr std::int64_t kUsual_q8 = 38, kUsualPoses = 3, kPerSquare_q8 = 1280, kFewPoses = 8;
std::int64_t scale_q8(const PoseFitResult& fit, int poses) {
  const std::int64_t disagreement_q8 = clamp<std::int64_t>(fit.disagreement_q8, 0, 1 << 20);
  const std::int64_t mean_q8 =
      divide(poses * disagreement_q8 + kUsualPoses * kUsual_q8, poses + kUsualPoses - 2);
  const std::int64_t per_square_q8 = divide(kPerSquare_q8 * (poses + kFewPoses), poses);
  return max<std::int64_t>(1, (((mean_q8 * mean_q8) >> 8) * per_square_q8) >> 8);
}

constexpr std::int64_t kTenthsPerPeriod = 27;
constexpr std::int64_t kMostVariance = 4096;  // times that of an unknown whose neighbours are known

using Unknowns = std::array<std::int64_t, kMotionUnknowns>;
using Inverse = std::array<std::array<std::int32_t, kMotionUnknowns>, kMotionUnknowns>;  // its columns, Q18

// Root of the information about each unknown alone, Q10.
Unknowns roots_q10(const std::array<std::int64_t, kMotionElements>& information_q4) {
  Unknowns root_q10{};
  for (int i = 0; i < kMotionUnknowns; ++i) {
    const std::int64_t information =
        clamp<std::int64_t>(information_q4[element(i, i)], 1, std::int64_t{1} << 46);
    root_q10[static_cast<std::size_t>(i)] = integer_sqrt(static_cast<std::uint64_t>(information << 16));
  }
  return root_q10;
}

// Of the information, scaled to a diagonal of ones.
Inverse inverse_of(const std::array<std::int64_t, kMotionElements>& information_q4,
                   const Unknowns& root_q10) {
  std::array<std::int64_t, kMotionElements> scaled{};
  for (int i = 0; i < kMotionUnknowns; ++i) {
    for (int k = 0; k < i; ++k) {
      // Q4 2^26 / (Q10 Q10) and 2^16 more in between: Q26.
      const std::int64_t half =
          divide(information_q4[element(i, k)] * (1 << 16), root_q10[static_cast<std::size_t>(i)]);
      scaled[element(i, k)] = divide(half * (1 << 26), root_q10[static_cast<std::size_t>(k)]);
    }
    scaled[element(i, i)] = std::int64_t{1} << 26;
  }
  Inverse inverse{};
  for (std::size_t i = 0; i < kMotionUnknowns; ++i) {
    Unknowns unit{};
    unit[i] = std::int64_t{1} << 20;
    inverse[i] = solve<kMotionUnknowns>(scaled, unit);
  }
  return inverse;
}

// Standard deviations without the floor. `scale_root_q8`: by which all of them are multiplied.
Unknowns own_sigmas(const Inverse& inverse, const Unknowns& root_q10, std::int64_t scale_root_q8,
                    std::int32_t target_radius_um) {
  Unknowns own_sigma{};
  for (int i = 0; i < kMotionUnknowns; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::int64_t variance_q18 = clamp<std::int64_t>(inverse[at][at], 1 << 18, kMostVariance << 18);
    const std::int64_t unit = i < kMotionUnknowns / 2 ? 1'000'000 : target_radius_um;
    const std::int64_t root_q9 = integer_sqrt(static_cast<std::uint64_t>(variance_q18));
    std::int64_t sigma = divide(root_q9 * unit * 2, root_q10[at]);
    const bool is_rate = i % 6 >= 3;
    if (is_rate) sigma = divide(sigma * 10, kTenthsPerPeriod);
    sigma = (sigma * scale_root_q8) >> 8;
    constexpr std::int64_t kHalfTurn_urad = 3'141'593;
    own_sigma[at] = clamp<std::int64_t>(sigma, 1, i < 3 ? kHalfTurn_urad : 1 << 30);
  }
  return own_sigma;
}

void add_floor(const Unknowns& own_sigma, PoseCovariance& covariance) {
  for (std::size_t i = 0; i < kMotionUnknowns; ++i) {
    const std::int64_t floor = kFloor[i / 3];
    const auto square = static_cast<std::uint64_t>(own_sigma[i] * own_sigma[i] + floor * floor);
    covariance.sigma[i] = integer_sqrt(square);
  }
}

// The floor of one unknown is independent of the others'.
void correlate(const Inverse& inverse, const Unknowns& own_sigma, PoseCovariance& covariance) {
  std::size_t place = 0;
  for (std::size_t i = 1; i < kMotionUnknowns; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const std::int64_t roots =
          std::int64_t{integer_sqrt(static_cast<std::uint64_t>(max(inverse[i][i], 1)))} *
          integer_sqrt(static_cast<std::uint64_t>(max(inverse[k][k], 1)));
      const std::int64_t own_q15 =
          divide(std::int64_t{inverse[k][i]} * (1 << 15), max<std::int64_t>(roots, 1));
      const std::int64_t first_q15 = divide(own_sigma[i] << 15, covariance.sigma[i]);
      const std::int64_t second_q15 = divide(own_sigma[k] << 15, covariance.sigma[k]);
      const std::int64_t product =
          (((clamp<std::int64_t>(own_q15, -32767, 32767) * first_q15) >> 15) * second_q15) >> 15;
      covariance.correlation_q15[place++] = static_cast<std::int16_t>(product);
    }
  }
}

}  // namespace

void make_covariance(const PoseFitResult& fit, int poses, std::int32_t target_radius_um,
                     PoseCovariance& covariance) {
  const std::int64_t scale_root_q8 = integer_sqrt(static_cast<std::uint64_t>(scale_q8(fit, poses) << 8));
  const Unknowns root_q10 = roots_q10(fit.information);
  const Inverse inverse = inverse_of(fit.information, root_q10);
  const Unknowns own_sigma = own_sigmas(inverse, root_q10, scale_root_q8, target_radius_um);
  add_floor(own_sigma, covariance);
  correlate(inverse, own_sigma, covariance);
}

}  // namespace tumblesight::gnc
