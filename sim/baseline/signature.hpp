// Signature: a scan as a small centred image of silhouette and depth, quick to compare with thousands of
// others.
#pragma once

#include <array>
#include <cstdint>

#include "sim/baseline/target_scan.hpp"

namespace tumblesight::sim {

// 24 x 24 cells across the line to the centroid of the returns, row 0 at the top. Integers, so that a sum
// over the cells is the same in any order and the compiler may vectorise it.
struct Signature {
  static constexpr int kSide = 24;
  static constexpr int kCells = kSide * kSide;
  static constexpr int kFull = 64;  // a cell all of whose rays hit the target

  std::array<std::int16_t, kCells> cover{};  // 0..kFull: share of the rays that hit the target
  std::array<std::int16_t, kCells>
      depth{};  // cover times depth behind the mean of all returns over the target radius
  std::array<std::int16_t, kCells> known{};  // -1: some ray tells; 0: blocked or outside the frame
};

// The scan seen along `towards` (LRF, unit), turned about that line by roll_rad (right-handed). The image
// covers 2 target_radius_m and a tenth.
Signature signature_of(const TargetScan& scan, const Eigen::Vector3d& towards, double roll_rad,
                       double target_radius_m);

// The signature of the scan rolled by a further quarter turn.
Signature quarter_turned(const Signature& signature);

// Squared difference over the cells that `measured` knows: cover, and `depth_weight` times depth.
double difference(const Signature& measured, const Signature& rendered, double depth_weight);

}  // namespace tumblesight::sim
