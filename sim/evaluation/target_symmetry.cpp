#include "sim/evaluation/target_symmetry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

// Axes are given with few digits. The turns of a group of 60 are at least 6 degrees apart.
constexpr double kSame_rad = kRadPerDeg;
constexpr double kParallel = 0.99985;  // cosine of a degree

bool is_parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::abs(a.dot(b)) >= kParallel;
}

bool is_perpendicular(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::abs(a.dot(b)) <= std::sin(kSame_rad);
}

bool is_same(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const Eigen::Quaterniond between = a.conjugate() * b;
  return 2.0 * std::atan2(between.vec().norm(), std::abs(between.w())) <= kSame_rad;
}

Eigen::Quaterniond turn_of(const TurnAxis& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(2.0 * kPi / axis.fold, axis.axis_trf));
}

std::vector<Eigen::Quaterniond> generated(const std::vector<TurnAxis>& axes) {
  std::vector<Eigen::Quaterniond> turns{Eigen::Quaterniond::Identity()};
  for (std::size_t i = 0; i < turns.size(); ++i) {
    for (const TurnAxis& axis : axes) {
      const Eigen::Quaterniond next = (turns[i] * turn_of(axis)).normalized();
      if (std::any_of(turns.begin(), turns.end(), [&](const auto& turn) { return is_same(turn, next); }))
        continue;
      turns.push_back(next);
      if (turns.size() > kMostTurns)
        throw std::invalid_argument(
            fmt::format("these axes make more than {} attitudes look the same; are the angles between them "
                        "right? A body that any turn about an axis leaves the same has the fold any",
                        kMostTurns));
    }
  }
  return turns;
}

// Besides the turns about `axis`: none, or a half turn across it.
std::vector<Eigen::Quaterniond> generated_around(const Eigen::Vector3d& axis,
                                                 const std::vector<TurnAxis>& axes) {
  std::vector<Eigen::Quaterniond> turns{Eigen::Quaterniond::Identity()};
  for (const TurnAxis& other : axes) {
    if (is_parallel(other.axis_trf, axis)) continue;
    if (other.fold != 2 || !is_perpendicular(other.axis_trf, axis))
      throw std::invalid_argument(
          "a body of revolution with such another axis is a sphere, which has no attitude; beside the fold "
          "any "
          "only a half turn about an axis perpendicular to it is possible");
    if (turns.size() == 1) turns.push_back(turn_of(other));
  }
  return turns;
}

// The turn about the axis that brings `estimate` nearest to `truth`: the twist of the turn between them.
Eigen::Quaterniond turned_about(const Eigen::Vector3d& axis_trf, const Eigen::Quaterniond& estimate,
                                const Eigen::Quaterniond& truth) {
  const Eigen::Quaterniond between = estimate.conjugate() * truth;
  const double half_rad = std::atan2(between.vec().dot(axis_trf), between.w());
  return estimate * Eigen::Quaterniond(Eigen::AngleAxisd(2.0 * half_rad, axis_trf));
}

std::string axis_text(const Eigen::Vector3d& axis) {
  for (int i = 0; i < 3; ++i) {
    if (std::abs(axis[i]) >= kParallel) return std::string(1, "xyz"[i]);
  }
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", axis.x(), axis.y(), axis.z());
}

[[noreturn]] void refuse(const std::string& text) {
  throw std::invalid_argument(fmt::format(
      "'{}' is not AXIS:FOLD: the axis is x, y, z or three numbers of the target frame, and the fold "
      "2 to {} or any, for example z:4, z:any or 0.5,0.5,0.7:2",
      text, kMostTurns));
}

template <class Number>
std::optional<Number> number_from(const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<Eigen::Vector3d> axis_from(const std::string& text) {
  if (text == "x") return Eigen::Vector3d::UnitX();
  if (text == "y") return Eigen::Vector3d::UnitY();
  if (text == "z") return Eigen::Vector3d::UnitZ();
  Eigen::Vector3d axis;
  std::size_t start = 0;
  for (int i = 0; i < 3; ++i) {
    const std::size_t comma = text.find(',', start);
    if ((comma == std::string::npos) != (i == 2)) return std::nullopt;
    const std::optional<double> value = number_from<double>(text.substr(start, comma - start));
    if (!value || !(std::abs(*value) <= 1e6)) return std::nullopt;
    axis[i] = *value;
    start = comma + 1;
  }
  if (!(axis.norm() > 1e-6)) return std::nullopt;
  return axis.normalized();
}

}  // namespace

TargetSymmetry::TargetSymmetry(std::vector<TurnAxis> axes) : axes_(std::move(axes)) {
  for (const TurnAxis& axis : axes_) {
    if (axis.fold != kAnyTurn) continue;
    revolution_ = axis.axis_trf;
    break;
  }
  turns_ = revolution_ ? generated_around(*revolution_, axes_) : generated(axes_);
}

Eigen::Quaterniond nearest_equivalent(const Eigen::Quaterniond& estimate, const Eigen::Quaterniond& truth,
                                      const TargetSymmetry& symmetry) {
  if (symmetry.is_none()) return estimate;
  Eigen::Quaterniond nearest = estimate;
  double best = -1.0;  // cosine of half the angle to the truth
  for (const Eigen::Quaterniond& turn : symmetry.turns_trf()) {
    Eigen::Quaterniond other = estimate * turn;
    if (symmetry.axis_of_revolution_trf())
      other = turned_about(*symmetry.axis_of_revolution_trf(), other, truth);
    const double cosine = std::abs(other.dot(truth));
    if (cosine <= best) continue;
    best = cosine;
    nearest = other;
  }
  return nearest;
}

std::string to_string(const TargetSymmetry& symmetry) {
  std::string text;
  for (const TurnAxis& axis : symmetry.axes()) {
    const std::string turn = axis.fold == kAnyTurn ? "any turn" : fmt::format("1/{} turn", axis.fold);
    text += fmt::format("{}{} about {}", text.empty() ? "" : ", ", turn, axis_text(axis.axis_trf));
  }
  return text;
}

TargetSymmetry target_symmetry_from(const std::vector<std::string>& texts) {
  std::vector<TurnAxis> axes;
  for (const std::string& text : texts) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) refuse(text);
    const std::optional<Eigen::Vector3d> axis = axis_from(text.substr(0, colon));
    const std::string fold = text.substr(colon + 1);
    const std::optional<int> number = fold == "any" ? kAnyTurn : number_from<int>(fold);
    const bool possible =
        number && (fold == "any" || (*number >= 2 && *number <= static_cast<int>(kMostTurns)));
    if (!axis || !possible) refuse(text);
    axes.push_back({*axis, *number});
  }
  return TargetSymmetry(std::move(axes));
}

}  // namespace tumblesight::sim
