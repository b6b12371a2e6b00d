// Runs inferences under callgrind: one dump of its counters after each frame, for every instruction
// set of the processor that callgrind emulates. Prints the numerics, the kind of frame and the instruction
// set of each dump, in order.
#include <valgrind/callgrind.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>

#include "gnc/estimation/attitude_estimator.hpp"
#include "sim/world/frame_renderer.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/target/targets.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight {
namespace {

using gnc::DepthImage;
using gnc::RangeImage;

constexpr int kRays = 128;

// Of a field of view `times` as wide as the image at this range.
RangeImage empty_frame(double range_m, double times) {
  const double swath_m = 1e-3 * gnc::test_header().projection.swath_mm;
  const double fov_urad = 2e6 * std::atan(times * swath_m / (2.0 * range_m));
  RangeImage frame;
  frame.rays = kRays;
  frame.fov_urad = std::clamp(static_cast<std::uint32_t>(fov_urad), gnc::kMinFov_urad, gnc::kMaxFov_urad);
  return frame;
}

// Only 16 returns; every ray the nearest and every ray the farthest usable range; noise.
std::vector<RangeImage> drawn_frames(double times) {
  std::vector<RangeImage> all{empty_frame(50, times), empty_frame(10, times), empty_frame(500, times),
                              empty_frame(50, times)};
  std::mt19937 engine(9);
  for (std::size_t i = 0; i < kRays * kRays; ++i) {
    all[0].ranges[i] = static_cast<std::uint16_t>(i < 16 ? 6400 + i : 0);
    all[1].ranges[i] = static_cast<std::uint16_t>(1280 + i % 2);
    all[2].ranges[i] = static_cast<std::uint16_t>(64000 - i % 2);
    all[3].ranges[i] = static_cast<std::uint16_t>(6400 + engine() % 600);
  }
  return all;
}

struct Frames {
  const char* kind;
  std::vector<RangeImage> frames;
};

// With the frame's own rays, also those of the sensor model; and resampled, since the image covers too few.
std::vector<Frames> frames() {
  std::vector<RangeImage> all = drawn_frames(1.0), wide = drawn_frames(2.0);
  wide.erase(wide.begin() + 1);  // the widest field of view is no wider than the image there
  const sim::TriangleMesh mesh = sim::target_by_name("near_shoemaker");
  const sim::FlashLidar lidar(mesh);
  const sim::FrameRenderer renderer(lidar, sim::swath_m(mesh));
  const sim::Sequence sequence = sim::make_sequence({}, 3, 0);
  for (std::uint32_t i = 0; i < 6; ++i) {
    all.emplace_back();
    renderer.render(sequence, i, all.back());
  }
  return {{"own", all}, {"resampled", wide}};
}

template <class N>
void count(const Frames& kind) {
  const std::vector<std::uint8_t> image = gnc::random_model_image<N>(5);
  const auto estimator = std::make_unique<gnc::AttitudeEstimator<N>>();
  if (estimator->load(image.data(), image.size(), nullptr) != gnc::ModelStatus::kOk) std::abort();
  for (const gnc::InstructionSet set : gnc::kInstructionSets) {
    const gnc::Kernels<N>* const kernels = gnc::kernels_on<N>(set);
    if (kernels == nullptr) continue;
    estimator->network().use(*kernels);
    for (const RangeImage& frame : kind.frames) {
      gnc::AttitudeEstimate estimate;
      CALLGRIND_START_INSTRUMENTATION;
      CALLGRIND_TOGGLE_COLLECT;
      const gnc::FrameStatus status = estimator->step(frame, estimate);
      CALLGRIND_TOGGLE_COLLECT;
      CALLGRIND_STOP_INSTRUMENTATION;
      CALLGRIND_DUMP_STATS;
      if (status != gnc::FrameStatus::kOk) std::abort();
      std::printf("%s,%s,%s\n", N::kIsInteger ? "fixed" : "float32", kind.kind, to_string(set));
    }
  }
}

}  // namespace
}  // namespace tumblesight

int main() {
  for (const tumblesight::Frames& kind : tumblesight::frames()) {
    tumblesight::count<tumblesight::gnc::FixedPoint>(kind);
    tumblesight::count<tumblesight::gnc::Float32>(kind);
  }
  return 0;
}
