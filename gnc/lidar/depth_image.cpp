#include "gnc/lidar/depth_image.hpp"

#include <algorithm>
#include <cmath>

namespace tumblesight::gnc {
namespace {

constexpr int kMinRays = 16;
constexpr std::uint16_t kMinRangeCounts =
    static_cast<std::uint16_t>(kMinRange_m / RangeImage::kMetresPerCount);
constexpr std::uint16_t kMaxRangeCounts =
    static_cast<std::uint16_t>(kMaxRange_m / RangeImage::kMetresPerCount);
constexpr float kSmallestValue = 1.0F / 256.0F;  // a return is never mistaken for an empty cell

// Taylor series to x^11; below 1e-8 for the half FOV of at most 20 degrees.
float tan_small(float x) {
  const float s = x * x;
  return x *
         (1.0F + s * (0.333333333F +
                      s * (0.133333333F + s * (0.0539682540F + s * (0.0218694885F + s * 0.00886323553F)))));
}

// Slope of the rays of one column (or, negated, of one row) against the boresight.
float ray_slope(int index, int rays, float tan_half_fov) {
  return tan_half_fov * (static_cast<float>(2 * index + 1) / static_cast<float>(rays) - 1.0F);
}

bool usable(std::uint16_t range) {
  return range >= kMinRangeCounts && range <= kMaxRangeCounts;
}

// Calls visit(point in the LRF [m], 1 for a usable return or 0) for every ray; row_done() after each row.
template <class Visitor, class RowDone>
void for_each_ray(const RangeImage& frame, Visitor&& visit, RowDone&& row_done) {
  const float tan_half_fov = tan_small(static_cast<float>(frame.fov_urad) * 0.5e-6F);
  for (int row = 0; row < frame.rays; ++row) {
    const float v = -ray_slope(row, frame.rays, tan_half_fov);
    for (int column = 0; column < frame.rays; ++column) {
      const std::uint16_t range = frame.ranges[row * frame.rays + column];
      const float u = ray_slope(column, frame.rays, tan_half_fov);
      const float weight = usable(range) ? 1.0F : 0.0F;
      const float depth_m =
          weight * static_cast<float>(range) * RangeImage::kMetresPerCount / std::sqrt(1.0F + u * u + v * v);
      visit(Eigen::Vector3f(u * depth_m, depth_m, v * depth_m), weight);
    }
    row_done();
  }
}

struct Returns {
  int count = 0;
  std::uint16_t nearest = 0xFFFF;
  std::uint16_t farthest = 0;
};

Returns survey(const RangeImage& frame) {
  Returns returns;
  const int rays_total = frame.rays * frame.rays;
  for (int i = 0; i < rays_total; ++i) {
    const std::uint16_t range = frame.ranges[i];
    const bool good = usable(range);
    returns.count += good ? 1 : 0;
    returns.nearest = std::min(returns.nearest, good ? range : std::uint16_t{0xFFFF});
    returns.farthest = std::max(returns.farthest, good ? range : std::uint16_t{0});
  }
  return returns;
}

FrameStatus validate(const RangeImage& frame) {
  if (frame.rays < kMinRays || frame.rays > RangeImage::kMaxRays) return FrameStatus::kBadRayCount;
  if (frame.fov_urad < kMinFov_urad || frame.fov_urad > kMaxFov_urad) return FrameStatus::kBadFov;
  const Returns returns = survey(frame);
  if (returns.count < kMinReturns) return FrameStatus::kEmpty;
  if (returns.nearest == returns.farthest) return FrameStatus::kFlat;
  return FrameStatus::kOk;
}

// Cell index along one axis, or -1 outside the swath; `position` in swaths from the middle.
int cell_index(float position) {
  const float scaled = (position + 0.5F) * static_cast<float>(DepthImage::kSide);
  const bool inside = scaled >= 0.0F && scaled < static_cast<float>(DepthImage::kSide);
  return inside ? static_cast<int>(scaled) : -1;
}

// Of all usable returns. Summed row by row, which keeps the float error far below the sensor's resolution.
Eigen::Vector3f centroid_lrf_m(const RangeImage& frame) {
  Eigen::Vector3f total_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f row_m = Eigen::Vector3f::Zero();
  float count = 0.0F;
  for_each_ray(
      frame,
      [&](const Eigen::Vector3f& point_m, float weight) {
        row_m += point_m;
        count += weight;
      },
      [&] {
        total_m += row_m;
        row_m.setZero();
      });
  return total_m / count;
}

// The shortest turn of +y into `direction` (unit, within 90 degrees of +y).
Eigen::Matrix3f turn_of_y_to(const Eigen::Vector3f& direction) {
  const float x = direction.x();
  const float y = direction.y();
  const float z = direction.z();
  const float s = 1.0F / (1.0F + y);
  Eigen::Matrix3f turn;
  turn << 1.0F - s * x * x, x, -s * x * z,  //
      -x, y, -z,                            //
      -s * x * z, z, 1.0F - s * z * z;
  return turn;
}

// Sums depths and counts returns cell by cell, in the view.
void accumulate(const RangeImage& frame, const Eigen::Matrix3f& r_lrf_view, float swath_m,
                DepthImageScratch& scratch) {
  scratch.depth_sum_m.fill(0.0F);
  scratch.returns.fill(0.0F);
  const float per_swath = 1.0F / swath_m;
  const Eigen::Matrix3f r_view_lrf = r_lrf_view.transpose();
  for_each_ray(
      frame,
      [&](const Eigen::Vector3f& point_lrf_m, float weight) {
        const Eigen::Vector3f point_m = r_view_lrf * point_lrf_m;
        const int x = cell_index(point_m.x() * per_swath);
        const int y = cell_index(-point_m.z() * per_swath);
        const bool inside = x >= 0 && y >= 0;
        const int cell = inside ? y * DepthImage::kSide + x : 0;
        scratch.depth_sum_m[cell] += inside ? point_m.y() : 0.0F;
        scratch.returns[cell] += inside ? weight : 0.0F;
      },
      [] {});
}

void encode_centroid_relative(const DepthImageScratch& scratch, float centroid_m, float target_radius_m,
                              DepthImage& image) {
  const float scale = 0.5F / target_radius_m;
  for (int i = 0; i < DepthImage::kCells; ++i) {
    const float count = scratch.returns[i];
    const float depth_m = scratch.depth_sum_m[i] / std::max(count, 1.0F);
    const float value = std::min(1.0F, std::max(kSmallestValue, 0.5F + scale * (centroid_m - depth_m)));
    image.value[i] = count > 0.0F ? value : 0.0F;
  }
}

void encode_paper_maximum(const DepthImageScratch& scratch, DepthImage& image) {
  float largest_m = 0.0F;
  for (int i = 0; i < DepthImage::kCells; ++i) {
    image.value[i] = scratch.depth_sum_m[i] / std::max(scratch.returns[i], 1.0F);
    largest_m = std::max(largest_m, image.value[i]);
  }
  const float scale = largest_m > 0.0F ? 1.0F / largest_m : 0.0F;
  for (float& value : image.value) value *= scale;
}

}  // namespace

FrameStatus make_depth_image(const RangeImage& frame, const DepthProjection& projection,
                             DepthImageScratch& scratch, DepthImage& image) {
  const FrameStatus status = validate(frame);
  if (status != FrameStatus::kOk) return status;
  const bool centred = projection.encoding == DepthEncoding::kCentroidRelative;
  const Eigen::Vector3f centroid_m = centroid_lrf_m(frame);
  const float distance_m = centroid_m.norm();
  image.r_lrf_view = centred ? turn_of_y_to(centroid_m / distance_m) : Eigen::Matrix3f::Identity();
  accumulate(frame, image.r_lrf_view, projection.swath_m, scratch);
  if (centred) {
    encode_centroid_relative(scratch, distance_m, projection.target_radius_m, image);
  } else {
    encode_paper_maximum(scratch, image);
  }
  return FrameStatus::kOk;
}

}  // namespace tumblesight::gnc
