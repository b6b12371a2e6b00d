// Registration with any surface that is sound, any frames and whatever the network says of them. Every
// estimate must be within its ranges, and the same when everything is repeated.
#include "gnc/registration/pose_tracker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "gnc/attitude/quaternion.hpp"
#include "tests/fuzz/check_estimate.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tumblesight::fuzz {
namespace {

using gnc::Fixed;
using gnc::SurfaceMesh;

constexpr int kMostFrames = 4;
constexpr std::uint32_t kMostPerTwelve = 64;  // vertices, triangles and edges of a small surface

void put(std::vector<std::uint8_t>& bytes, std::uint16_t value) {
  bytes.push_back(static_cast<std::uint8_t>(value));
  bytes.push_back(static_cast<std::uint8_t>(value >> 8U));
}

// Of random corners that exist.
std::vector<std::uint8_t> surface_of(Input& input) {
  const auto vertices = static_cast<std::uint16_t>(3 + input.u8() % kMostPerTwelve);
  const auto triangles = static_cast<std::uint16_t>(1 + input.u8() % kMostPerTwelve);
  const auto edges = static_cast<std::uint16_t>(input.u8() % kMostPerTwelve);
  std::vector<std::uint8_t> section;
  for (const std::uint16_t number : {vertices, triangles, edges}) put(section, number);
  put(section, 5);
  for (int i = 0; i < 3 * vertices; ++i) put(section, input.u16());
  for (int i = 0; i < 3 * triangles + 4 * edges; ++i)
    put(section, static_cast<std::uint16_t>(input.u8() % vertices));
  require(SurfaceMesh::is_sound(section.data(), section.size()), "the surface is sound");
  return section;
}

gnc::Matrix3<Fixed> rotation_of(Input& input) {
  gnc::QuaternionQ30 q{};
  std::array<double, 4> part{};
  double square = 0.0;
  for (double& p : part) {
    p = static_cast<std::int16_t>(input.u16());
    square += p * p;
  }
  if (square == 0.0) return gnc::Matrix3<Fixed>::Identity();
  for (std::size_t i = 0; i < 4; ++i)
    q[i] = static_cast<std::int32_t>((1 << 30) * (part[i] / std::sqrt(square)));
  return gnc::rotation_from_quaternion(q);
}

// What one frame shows, and what the network says of it.
struct Shown {
  gnc::RangeImage image;
  gnc::RayMask mask{};
  std::int64_t elapsed_ns = 0;
  gnc::Matrix3<Fixed> turn, second;
  gnc::Motion<Fixed> network;
  std::uint32_t odds_ppm = 0;
  std::array<std::int32_t, 3> centroid_mm{};
  int motion_model = 0;
};

// Runs of rays with one range each, with or without the rays of the target.
void paint(Input& input, Shown& shown) {
  const std::size_t rays = std::size_t{shown.image.rays} * shown.image.rays;
  shown.image.ranges.fill(0);
  for (std::size_t at = 0; at < rays && !input.empty();) {
    const std::uint16_t range = input.u16();
    const std::uint16_t run = input.u16();
    const std::size_t end = std::min(rays, at + (run >> 1U) + 1);
    for (; at < end; ++at) {
      shown.image.ranges[at] = range;
      const std::size_t row = at / shown.image.rays, column = at % shown.image.rays;
      if ((run & 1U) != 0 && range != 0) shown.mask.rows[row][column / 32] |= 0x8000'0000U >> (column % 32);
    }
  }
}

std::unique_ptr<Shown> shown_of(Input& input) {
  auto shown = std::make_unique<Shown>();
  shown->elapsed_ns = static_cast<std::int64_t>(input.u64() % (2 * gnc::kLongestPropagation_ns));
  shown->turn = rotation_of(input);
  shown->network.r_lrf_trf = rotation_of(input);
  for (int i = 0; i < 3; ++i)
    shown->network.rate_lrf[i] = Fixed::from_raw(static_cast<std::int32_t>(input.u32()) >> 4);
  shown->second = rotation_of(input);
  shown->odds_ppm = input.u32();
  for (std::int32_t& mm : shown->centroid_mm)
    mm = static_cast<std::int32_t>(input.u32() % 1'000'001) - 500'000;
  shown->motion_model = input.u8() % gnc::kMotionModels;
  shown->image.rays = static_cast<std::uint16_t>(16 + input.u8() % (gnc::RangeImage::kMaxRays - 15));
  shown->image.fov_urad = gnc::kMinFov_urad + input.u32() % (gnc::kMaxFov_urad - gnc::kMinFov_urad + 1);
  return shown;
}

void check(const gnc::PoseEstimate& estimate) {
  check_quaternion(estimate.state.q_lrf_trf);
  require(estimate.poses >= 0 && estimate.poses <= gnc::PoseHistory::kMost, "there are at most ten poses");
  for (const std::int16_t correlation : estimate.covariance.correlation_q15)
    require(correlation > INT16_MIN, "a correlation is within -1 and 1");
  if (!estimate.is_verified()) return;
  require(estimate.poses >= 3, "a verified pose is one of three at least");
  for (const std::uint32_t sigma : estimate.covariance.sigma)
    require(sigma > 0, "nothing is known without an error");
}

// A track over all frames.
std::vector<gnc::PoseEstimate> track(const std::vector<std::uint8_t>& section, const gnc::PoseTarget& target,
                                     const std::vector<std::unique_ptr<Shown>>& frames) {
  static gnc::PoseScratch scratch;
  static gnc::ScreenVertices vertices;
  const gnc::MotionModels<Fixed> motion_models = gnc::motion_models<Fixed>(gnc::Inertia<Fixed>());
  auto state = std::make_unique<gnc::PoseTrackerState>();
  const gnc::PoseTarget with_mesh{SurfaceMesh(section.data()), target.radius_mm, target.noise};
  std::vector<gnc::PoseEstimate> estimates;
  for (const auto& shown : frames) {
    const gnc::PoseFrame frame{shown->image,   shown->mask,        shown->elapsed_ns, shown->turn,
                               shown->network, shown->second,      shown->odds_ppm,   shown->centroid_mm,
                               motion_models,  shown->motion_model};
    track_pose(with_mesh, frame, scratch, vertices, *state, estimates.emplace_back());
    check(estimates.back());
    require(state->conservative_llr_q8 <= state->llr_q8, "no more is proven than the advantage");
    const gnc::PoseMotion later =
        later_pose(*state, motion_models, shown->elapsed_ns, gnc::Matrix3<Fixed>::Identity());
    check_quaternion(pose_state(later).q_lrf_trf);
  }
  return estimates;
}

}  // namespace
}  // namespace tumblesight::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  using namespace tumblesight::fuzz;
  Input input(data, size);
  const std::vector<std::uint8_t> section = surface_of(input);
  const gnc::PoseTarget target{{}, gnc::kMinProjection_mm + input.u24() % 49'900, {input.u16(), input.u16()}};
  std::vector<std::unique_ptr<Shown>> frames;
  while (frames.size() < kMostFrames && !input.empty()) {
    frames.push_back(shown_of(input));
    paint(input, *frames.back());
  }
  const std::vector<gnc::PoseEstimate> first = track(section, target, frames);
  const std::vector<gnc::PoseEstimate> again = track(section, target, frames);
  for (std::size_t i = 0; i < first.size(); ++i)
    require(first[i].doubts == again[i].doubts &&
                first[i].conservative_llr_q8 == again[i].conservative_llr_q8 &&
                first[i].state.q_lrf_trf == again[i].state.q_lrf_trf &&
                first[i].state.origin_lrf_um == again[i].state.origin_lrf_um &&
                first[i].covariance.sigma == again[i].covariance.sigma,
            "the same frames give the same poses");
  return 0;
}
