#include "sim/evaluation/chance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kHalf = 0.5;
constexpr int kAttitudes = 20'000;
// A network that knows nothing of a target prefers some attitudes. That moves the mean a little.
constexpr double kNearChance = 0.1;
constexpr double kStandardErrors = 2.0;

double fraction(double value) {
  return value - std::floor(value);
}

// The i-th of a sequence that fills the attitudes evenly: the additive recurrence of the root of x^4 = x + 1,
// mapped by Shoemake's formula for uniform quaternions.
Eigen::Quaterniond even_attitude(int i) {
  constexpr double kRoot = 1.2207440846057596;
  const double u = fraction(0.5 + i / kRoot);
  const double a = 2.0 * kPi * fraction(0.5 + i / (kRoot * kRoot));
  const double b = 2.0 * kPi * fraction(0.5 + i / (kRoot * kRoot * kRoot));
  return {std::sqrt(1.0 - u) * std::sin(a), std::sqrt(1.0 - u) * std::cos(a), std::sqrt(u) * std::sin(b),
          std::sqrt(u) * std::cos(b)};
}

bool is_near_chance(const ErrorSummary& errors, double chance_deg) {
  return std::abs(errors.mean_deg - chance_deg) <=
         std::max(kNearChance * chance_deg, kStandardErrors * errors.mean_standard_error_deg);
}

}  // namespace

double chance_mean_deg(const TargetSymmetry& symmetry) {
  if (symmetry.is_none()) return kDegPerRad * (kPi / 2.0 + 2.0 / kPi);
  // The axis points anywhere on a sphere, or on half of one.
  if (symmetry.axis_of_revolution_trf()) return symmetry.turns_trf().size() == 1 ? 90.0 : kDegPerRad;
  const Eigen::Quaterniond truth = Eigen::Quaterniond::Identity();
  double sum_rad = 0.0;
  for (int i = 0; i < kAttitudes; ++i)
    sum_rad += angular_error_rad(truth, nearest_equivalent(even_attitude(i), truth, symmetry));
  return kDegPerRad * sum_rad / kAttitudes;
}

bool is_mostly_wrong(const ErrorSummary& errors) {
  return errors.count > 0 && errors.within_20deg < kHalf;
}

std::string mostly_wrong_text(const ErrorSummary& errors, const TargetSymmetry& symmetry) {
  if (!is_mostly_wrong(errors)) return {};
  const std::string text =
      fmt::format("{:.0f} % of the attitudes are more than {:g}° off, and their mean error of {:.1f}°",
                  100.0 * (1.0 - errors.within_20deg), kWrong_deg, errors.mean_deg);
  const double chance_deg = chance_mean_deg(symmetry);
  if (!is_near_chance(errors, chance_deg)) return text + " is of no use.";
  return text +
         fmt::format(" is what guessing gives: an attitude drawn at random is off by {:.1f}° on average.",
                     chance_deg);
}

}  // namespace tumblesight::sim
