// Signature: a scan as a small centred image of silhouette and depth, which can be compared quickly with
// thousands of others.
#pragma once

#include <array>
#include <cstdint>

#include "sim/baseline/target_scan.hpp"

namespace tumblesight::sim {

// 24 x 24 cells across the line to the centroid of the returns, row 0 at the top. Integers, so that the
// result of a sum over the cells does not depend on its order and the compiler can vectorize it.
struct Signature {
  static constexpr int kSide = 24;
  static constexpr int kCells = kSide * kSide;
  static constexpr int kFull = 64;  // value of a cell if all its rays hit the target

  std::array<std::int16_t, kCells> cover{};  // 0..kFull: share of the rays that hit the target
  std::array<std::int16_t, kCells>
      depth{};  // cover times (depth behind the mean of all returns over the target radius)
  std::array<std::int16_t, kCells> known{};  // -1 (all bits): known; 0: blocked or outside the frame
};

// The scan seen along `towards` (LRF, unit vector), rotated about that line by roll_rad (right-handed). The
// image covers 2.2 target_radius_m.
Signature signature_of(const TargetScan& scan, const Eigen::Vector3d& towards, double roll_rad,
                       double target_radius_m);

// The signature of the same scan, rolled by another quarter turn.
Signature quarter_turned(const Signature& signature);

// Sum of squared differences over the known cells of `measured`: of cover, plus `depth_weight` times that of
// depth.
double difference(const Signature& measured, const Signature& rendered, double depth_weight);

}  // namespace tumblesight::sim
