#include "sim/baseline/silhouette.hpp"

#include <algorithm>
#include <cmath>

namespace tumblesight::sim {
namespace {

constexpr int kFar = 1 << 12;  // no such ray; its square fits an int

bool touches_blocked(const TargetScan& scan, int ray) {
  const int row = ray / scan.rays, column = ray % scan.rays;
  for (int r = std::max(0, row - 1); r <= std::min(scan.rays - 1, row + 1); ++r) {
    for (int c = std::max(0, column - 1); c <= std::min(scan.rays - 1, column + 1); ++c) {
      if (scan.kind[r * scan.rays + c] == RayKind::kBlocked) return true;
    }
  }
  return false;
}

}  // namespace

// Danielsson's vector distance transform: downwards with passes to the right and to the left, then upwards
// the same way.
void SilhouetteField::sweep(std::vector<Step>& steps) const {
  const auto improve = [&](int row, int column, int step_right, int step_down) {
    const int from_row = row + step_down, from_column = column + step_right;
    if (from_row < 0 || from_row >= rays_ || from_column < 0 || from_column >= rays_) return;
    Step through = steps[from_row * rays_ + from_column];
    through.right += step_right;
    through.down += step_down;
    Step& here = steps[row * rays_ + column];
    if (through.squared() < here.squared()) here = through;
  };
  const auto pass = [&](int row, int previous) {
    for (int c = 0; c < rays_; ++c) improve(row, c, 0, previous);
    for (int c = 1; c < rays_; ++c) improve(row, c, -1, 0);
    for (int c = rays_ - 2; c >= 0; --c) improve(row, c, 1, 0);
  };
  for (int row = 0; row < rays_; ++row) pass(row, -1);
  for (int row = rays_ - 1; row >= 0; --row) pass(row, 1);
}

std::vector<SilhouetteField::Step> SilhouetteField::nearest(const std::vector<bool>& sought) const {
  std::vector<Step> steps(sought.size());
  for (std::size_t i = 0; i < sought.size(); ++i) steps[i] = sought[i] ? Step{0, 0} : Step{kFar, kFar};
  sweep(steps);
  return steps;
}

SilhouetteField::SilhouetteField(const TargetScan& scan)
    : rays_(scan.rays), inside_(scan.kind.size()), known_(scan.kind.size()) {
  std::vector<bool> outside(scan.kind.size());
  for (std::size_t i = 0; i < inside_.size(); ++i) {
    inside_[i] = scan.on_target(static_cast<int>(i));
    outside[i] = !inside_[i];
  }
  steps_ = nearest(inside_);
  const std::vector<Step> inwards = nearest(outside);
  for (std::size_t i = 0; i < inside_.size(); ++i) {
    if (inside_[i]) steps_[i] = inwards[i];
    const int ray = static_cast<int>(i);
    const int edge = ray + steps_[i].down * rays_ + steps_[i].right;
    known_[i] =
        steps_[i].right < kFar / 2 && scan.kind[ray] != RayKind::kBlocked && !touches_blocked(scan, edge);
  }
}

bool SilhouetteField::at(double column, double row, Distance& distance) const {
  const int c = static_cast<int>(std::lround(column)), r = static_cast<int>(std::lround(row));
  if (c < 0 || c >= rays_ || r < 0 || r >= rays_) return false;
  const int ray = r * rays_ + c;
  if (!known_[ray]) return false;
  const Step& step = steps_[ray];
  const double length = std::sqrt(static_cast<double>(step.squared()));
  const double sign = inside_[ray] ? -1.0 : 1.0;
  // Outwards is away from the nearest ray on the target, or towards the nearest one outside it.
  distance.outwards = Eigen::Vector2d(-step.right, step.down) * (sign / length);
  distance.out_rays = sign * (length - 0.5) + distance.outwards.dot(Eigen::Vector2d(column - c, r - row));
  return true;
}

}  // namespace tumblesight::sim
