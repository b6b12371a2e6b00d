// Counts the instructions of inferences under callgrind: one dump of the counters after each of ten frames,
// for every instruction set that the processor emulated by callgrind has. Prints the numerics and the set of
// each dump, in order.
#include <valgrind/callgrind.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>

#include "gnc/rcnn/attitude_estimator.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/sensor/flash_lidar.hpp"
#include "sim/world/target/targets.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight {
namespace {

using gnc::DepthImage;
using gnc::RangeImage;

constexpr int kRays = 128;

RangeImage empty_frame() {
  RangeImage frame;
  frame.rays = kRays;
  frame.fov_urad = 140'000;
  return frame;
}

// Sixteen returns only, every ray at the nearest or farthest range, noise, and rendered frames.
std::vector<RangeImage> frames() {
  std::vector<RangeImage> all(4, empty_frame());
  std::mt19937 engine(9);
  for (std::size_t i = 0; i < kRays * kRays; ++i) {
    all[0].ranges[i] = static_cast<std::uint16_t>(i < 16 ? 6400 + i : 0);
    all[1].ranges[i] = static_cast<std::uint16_t>(1280 + i % 2);
    all[2].ranges[i] = static_cast<std::uint16_t>(64000 - i % 2);
    all[3].ranges[i] = static_cast<std::uint16_t>(engine());
  }
  const sim::TriangleMesh mesh = sim::target_by_name("near_shoemaker");
  const sim::FlashLidar lidar(mesh);
  sim::ScenarioSettings settings;
  const sim::Sequence sequence = sim::make_sequence(settings, 3, 0);
  for (std::size_t i = 0; i < 6; ++i) {
    all.push_back(empty_frame());
    lidar.expose(sequence.frames[i], sim::sensor_settings(settings.condition), sim::swath_m(mesh), i,
                 all.back());
  }
  return all;
}

template <class N>
void count(const std::vector<RangeImage>& frames) {
  const std::vector<std::uint8_t> image = gnc::random_model_image<N>(5);
  const auto estimator = std::make_unique<gnc::AttitudeEstimator<N>>();
  if (estimator->load(image.data(), image.size(), nullptr) != gnc::ModelStatus::kOk) std::abort();
  for (const gnc::InstructionSet set : gnc::kInstructionSets) {
    const gnc::Kernels<N>* const kernels = gnc::kernels_on<N>(set);
    if (kernels == nullptr) continue;
    estimator->network().use(*kernels);
    for (const RangeImage& frame : frames) {
      gnc::AttitudeEstimate estimate;
      CALLGRIND_START_INSTRUMENTATION;
      CALLGRIND_TOGGLE_COLLECT;
      const gnc::FrameStatus status = estimator->step(frame, estimate);
      CALLGRIND_TOGGLE_COLLECT;
      CALLGRIND_STOP_INSTRUMENTATION;
      CALLGRIND_DUMP_STATS;
      if (status != gnc::FrameStatus::kOk) std::abort();
      std::printf("%s,%s\n", N::kIsInteger ? "fixed" : "float32", to_string(set));
    }
  }
}

}  // namespace
}  // namespace tumblesight

int main() {
  const std::vector<tumblesight::gnc::RangeImage> frames = tumblesight::frames();
  tumblesight::count<tumblesight::gnc::FixedPoint>(frames);
  tumblesight::count<tumblesight::gnc::Float32>(frames);
  return 0;
}
