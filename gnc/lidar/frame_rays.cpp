#include "gnc/lidar/frame_rays.hpp"

#include <cmath>

#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {
namespace {

// The rows or columns of the sensor that a row or column of the frame stands for.
struct Cell {
  int first = 0;
  int last = -1;
};
using Cells = std::array<Cell, RangeImage::kMaxRays>;

float slope_of(const FrameWindow& window, int index) {
  const auto steps = static_cast<float>(2 * index + 1 - window.rays);
  return window.tan_half_fov * steps / static_cast<float>(window.rays);
}

int nearest_to(float slope, const SensorRays& sensor) {
  int nearest = 0;
  for (int i = 1; i < sensor.rays; ++i) {
    if (std::abs(sensor.slope[i] - slope) < std::abs(sensor.slope[nearest] - slope)) nearest = i;
  }
  return nearest;
}

void make_cells(const SensorRays& sensor, const FrameWindow& window, Cells& cells) {
  const float cells_per_slope = static_cast<float>(window.rays) / (2.0F * window.tan_half_fov);
  for (int i = 0; i < sensor.rays; ++i) {
    const float place = std::floor((sensor.slope[i] + window.tan_half_fov) * cells_per_slope);
    if (place < 0.0F || place >= static_cast<float>(window.rays)) continue;
    Cell& cell = cells[static_cast<std::size_t>(place)];
    if (cell.last < 0) cell.first = i;
    cell.last = i;
  }
  for (int i = 0; i < window.rays; ++i) {
    Cell& cell = cells[static_cast<std::size_t>(i)];
    if (cell.last < 0) cell.first = cell.last = nearest_to(slope_of(window, i), sensor);
  }
}

// The nearest return of the sensor's rays in a cell; 0 without any.
std::uint16_t range_in(const std::uint16_t* ranges, const SensorRays& sensor, const FrameWindow& window,
                       const Cells& cells, int row, int column) {
  const float right = slope_of(window, column);
  const float down = slope_of(window, row);
  const float square = 1.0F + right * right + down * down;
  const Cell rows = cells[static_cast<std::size_t>(row)];
  const Cell columns = cells[static_cast<std::size_t>(column)];
  float nearest = 0.0F;
  for (int r = rows.first; r <= rows.last; ++r) {
    for (int c = columns.first; c <= columns.last; ++c) {
      const std::uint16_t counts = ranges[r * sensor.rays + c];
      const float x = sensor.slope[c];
      const float y = sensor.slope[r];
      const float range = static_cast<float>(counts) * std::sqrt(square / (1.0F + x * x + y * y));
      if (counts != 0 && (nearest == 0.0F || range < nearest)) nearest = range;
    }
  }
  constexpr float kLargest = 65535.0F;
  if (nearest == 0.0F) return 0;
  return static_cast<std::uint16_t>(nearest < 1.0F ? 1.0F : min(kLargest, nearest + 0.5F));
}

}  // namespace

int rays_with_returns(const std::uint16_t* ranges, int rays) {
  int outermost = rays;  // rings between the edge and the outermost return
  for (int row = 0; row < rays; ++row) {
    for (int column = 0; column < rays; ++column) {
      if (ranges[row * rays + column] == 0) continue;
      const int from_row = row < rays - 1 - row ? row : rays - 1 - row;
      const int from_column = column < rays - 1 - column ? column : rays - 1 - column;
      const int ring = from_row < from_column ? from_row : from_column;
      if (ring < outermost) outermost = ring;
    }
  }
  return outermost == rays ? 0 : rays - 2 * outermost;
}

void make_frame(const std::uint16_t* ranges, const SensorRays& sensor, const FrameWindow& window,
                RangeImage& frame) {
  Cells cells{};
  make_cells(sensor, window, cells);
  frame.rays = static_cast<std::uint16_t>(window.rays);
  frame.fov_urad = window.fov_urad;
  frame.ranges.fill(0);
  for (int row = 0; row < window.rays; ++row) {
    for (int column = 0; column < window.rays; ++column) {
      frame.ranges[row * window.rays + column] = range_in(ranges, sensor, window, cells, row, column);
    }
  }
}

}  // namespace tumblesight::gnc
