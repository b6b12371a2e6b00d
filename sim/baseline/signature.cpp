#include "sim/baseline/signature.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace tumblesight::sim {
namespace {

constexpr double kMargin = 1.1;
constexpr float kEnoughRays = 0.25F;  // rays needed in a cell to know its cover

struct Cells {
  std::array<float, Signature::kCells> rays{}, hits{}, depth{};

  // Distributed over the four nearest cells, so that a shift by part of a cell has little effect.
  void add(double column, double row, bool hit, float depth_m) {
    const int c = static_cast<int>(std::floor(column)), r = static_cast<int>(std::floor(row));
    for (int i = 0; i < 4; ++i) {
      const int to_c = c + i % 2, to_r = r + i / 2;
      if (to_c < 0 || to_c >= Signature::kSide || to_r < 0 || to_r >= Signature::kSide) continue;
      const double share = (1.0 - std::abs(column - to_c)) * (1.0 - std::abs(row - to_r));
      const int cell = to_r * Signature::kSide + to_c;
      const auto weight = static_cast<float>(share);
      rays[cell] += weight;
      if (!hit) continue;
      hits[cell] += weight;
      depth[cell] += weight * depth_m;
    }
  }
};

Signature quantised(const Cells& cells, double target_radius_m) {
  Signature signature;
  for (int i = 0; i < Signature::kCells; ++i) {
    if (cells.rays[i] < kEnoughRays) continue;
    signature.known[i] = -1;
    const double scale = Signature::kFull / cells.rays[i];
    const double depth = std::clamp<double>(cells.depth[i] / target_radius_m, -cells.hits[i], cells.hits[i]);
    signature.cover[i] = static_cast<std::int16_t>(std::lround(scale * cells.hits[i]));
    signature.depth[i] = static_cast<std::int16_t>(std::lround(scale * depth));
  }
  return signature;
}

}  // namespace

Signature signature_of(const TargetScan& scan, const Eigen::Vector3d& towards, double roll_rad,
                       double target_radius_m) {
  const Eigen::Matrix3d r_view_lrf = (Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitY()) *
                                      Eigen::Quaterniond::FromTwoVectors(towards, Eigen::Vector3d::UnitY()))
                                         .toRotationMatrix();
  const double cells_to_slope = scan.centre_range_m * Signature::kSide / (2.0 * kMargin * target_radius_m);
  const double middle = 0.5 * (Signature::kSide - 1);
  Cells cells;
  for (int ray = 0; ray < scan.rays * scan.rays; ++ray) {
    if (scan.kind[ray] == RayKind::kBlocked || scan.kind[ray] == RayKind::kLost) continue;
    const Eigen::Vector3d view =
        r_view_lrf * Eigen::Vector3d(scan.slope(ray % scan.rays), 1.0, -scan.slope(ray / scan.rays));
    cells.add(middle + cells_to_slope * view.x() / view.y(), middle - cells_to_slope * view.z() / view.y(),
              scan.kind[ray] == RayKind::kReturn,
              scan.range_m[ray] - static_cast<float>(scan.centre_range_m));
  }
  return quantised(cells, target_radius_m);
}

Signature quarter_turned(const Signature& signature) {
  Signature turned;
  for (int row = 0; row < Signature::kSide; ++row) {
    for (int column = 0; column < Signature::kSide; ++column) {
      // A quarter turn about +y takes (right, up) to (up, -right).
      const int to = column * Signature::kSide + (Signature::kSide - 1 - row);
      const int from = row * Signature::kSide + column;
      turned.cover[to] = signature.cover[from];
      turned.depth[to] = signature.depth[from];
      turned.known[to] = signature.known[from];
    }
  }
  return turned;
}

double difference(const Signature& measured, const Signature& rendered, double depth_weight) {
  std::int32_t cover = 0, depth = 0;
  for (int i = 0; i < Signature::kCells; ++i) {
    const auto c = static_cast<std::int16_t>((measured.cover[i] - rendered.cover[i]) & measured.known[i]);
    const auto d = static_cast<std::int16_t>((measured.depth[i] - rendered.depth[i]) & measured.known[i]);
    cover += c * c;
    depth += d * d;
  }
  return cover + depth_weight * depth;
}

}  // namespace tumblesight::sim
