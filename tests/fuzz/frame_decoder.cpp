// Frames of any content, given to make_depth_image() with the instruction sets of this processor and, for
// some inputs, to the estimator.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "gnc/lidar/depth_loops.hpp"
#include "tests/fuzz/check_estimate.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::fuzz {
namespace {

enum : std::uint8_t { kAnySize = 1, kAnyProjection = 2, kRepeated = 4, kNextFrame = 8 };
constexpr std::uint32_t kSteps = 4096;  // one input in kSteps: a step is slow

// Fills runs of rays with equal or scattered ranges, so that a few bytes make a frame.
void paint(Input& input, std::size_t rays, gnc::RangeImage& frame) {
  std::size_t at = 0;
  while (at < rays && !input.empty()) {
    const std::uint32_t range = input.u16();
    const std::uint32_t scatter = input.u8();
    const std::size_t end = std::min<std::size_t>(rays, at + input.u16());
    for (; at < end; ++at) {
      const auto random = static_cast<std::uint32_t>(at) * 2654435761U >> 16;
      frame.ranges[at] = static_cast<std::uint16_t>(range + random % (scatter + 1));
    }
  }
}

// Repeats a few ranges over the whole frame, doubling them with every copy.
void repeat(Input& input, std::size_t rays, gnc::RangeImage& frame) {
  std::size_t count = 0;
  while (input.left() >= 2 && count < rays) frame.ranges[count++] = input.u16();
  while (count > 0 && count < rays) {
    const std::size_t more = std::min(count, rays - count);
    std::copy_n(frame.ranges.begin(), more, frame.ranges.begin() + static_cast<std::ptrdiff_t>(count));
    count += more;
  }
}

// Any valid side, short ones more often: the cost of a frame is its square.
std::uint16_t some_side(std::uint16_t number) {
  constexpr unsigned kSides = gnc::RangeImage::kMaxRays - 15;
  return static_cast<std::uint16_t>(16 + std::min(number % kSides, number / kSides % kSides));
}

gnc::RangeImage frame_of(Input& input, std::uint8_t flags) {
  gnc::RangeImage frame;
  frame.exposure_time_ns = static_cast<std::int64_t>(input.u64());
  frame.sequence_number = input.u32();
  const std::uint16_t rays = input.u16();
  const std::uint32_t fov_urad = input.u32();
  const bool any = (flags & kAnySize) != 0;
  frame.rays = any ? rays : some_side(rays);
  frame.fov_urad =
      any ? fov_urad : gnc::kMinFov_urad + fov_urad % (gnc::kMaxFov_urad - gnc::kMinFov_urad + 1);
  const std::size_t side = std::min<std::size_t>(frame.rays, gnc::RangeImage::kMaxRays);
  (flags & kRepeated) != 0 ? repeat(input, side * side, frame) : paint(input, side * side, frame);
  return frame;
}

gnc::DepthProjection projection_of(Input& input, std::uint8_t flags) {
  if ((flags & kAnyProjection) == 0) return gnc::test_header().projection;
  const auto length = [&input](std::uint32_t largest_mm) {
    return gnc::kMinProjection_mm + input.u24() % (largest_mm - gnc::kMinProjection_mm + 1);
  };
  const std::uint32_t swath_mm = length(gnc::kMaxSwath_mm);
  return {swath_mm, length(gnc::kMaxTargetRadius_mm)};
}

void check_image(const gnc::DepthImage& image) {
  for (const std::uint16_t depth : image.depth) {
    require(depth == 0 || depth >= gnc::DepthImage::kSmallest, "a return never looks like an empty cell");
  }
  const gnc::Matrix3<gnc::Fixed>& view = image.r_lrf_view;
  const double trace = gnc::trace_of_transpose_product<gnc::Fixed>(view, view).raw() * std::ldexp(1.0, -24);
  require(std::abs(trace - 3.0) < 1e-5, "the view is a rotation");
}

struct Decoded {
  gnc::FrameStatus status;
  gnc::DepthImage image;
};

// The scratch memory keeps what earlier frames have left in it.
void decode(const gnc::RangeImage& frame, const gnc::DepthProjection& projection, gnc::InstructionSet set,
            Decoded& decoded) {
  static gnc::DepthImageScratch scratch;
  decoded.status =
      gnc::make_depth_image(frame, projection, scratch, decoded.image, gnc::fastest_depth_loops(set));
}

// Compares the portable loops with those of one instruction set.
void check_set(const gnc::RangeImage& frame, const gnc::DepthProjection& projection,
               gnc::InstructionSet set) {
  static Decoded first, other;
  decode(frame, projection, gnc::InstructionSet::kPortable, first);
  if (first.status == gnc::FrameStatus::kOk) check_image(first.image);
  if (gnc::fastest_depth_loops(set).set != set) return;  // not in this build or not on this processor
  decode(frame, projection, set, other);
  require(other.status == first.status, "the status is the same with every instruction set");
  if (first.status != gnc::FrameStatus::kOk) return;
  require(other.image.depth == first.image.depth, "the image is the same with every instruction set");
  require(other.image.r_lrf_view == first.image.r_lrf_view,
          "the view is the same with every instruction set");
}

class Estimator {
 public:
  Estimator() {
    const std::vector<std::uint8_t>& image = gnc::lasting_model_image<gnc::FixedPoint>(1);
    require(estimator_->load(image.data(), image.size(), nullptr) == gnc::ModelStatus::kOk,
            "the model is good");
  }
  // `next`: continues the current track.
  void step(const gnc::RangeImage& frame, bool next) {
    if (!next) estimator_->reset();
    const std::uint32_t before = estimator_->state_crc32();
    gnc::AttitudeEstimate estimate;
    if (estimator_->step(frame, estimate) == gnc::FrameStatus::kOk) {
      check_estimate(estimate);
    } else {
      require(estimator_->state_crc32() == before, "a refused frame leaves the state untouched");
    }
  }

 private:
  std::unique_ptr<gnc::AttitudeEstimator<gnc::FixedPoint>> estimator_ =
      std::make_unique<gnc::AttitudeEstimator<gnc::FixedPoint>>();
};

}  // namespace
}  // namespace tumblesight::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  using namespace tumblesight::fuzz;
  static Estimator estimator;
  Input input(data, size);
  const bool steps = is_chosen(input, kSteps);
  const std::uint8_t flags = input.u8();
  const gnc::DepthProjection projection = projection_of(input, flags);
  static gnc::RangeImage frame;
  frame = frame_of(input, flags);
#ifdef TUMBLESIGHT_FUZZ  // one set per input: each costs as much as everything else
  check_set(frame, projection, size % 2 == 0 ? gnc::InstructionSet::kAvx512 : gnc::InstructionSet::kAvx2);
#else
  for (const auto set : {gnc::InstructionSet::kAvx2, gnc::InstructionSet::kAvx512})
    check_set(frame, projection, set);
#endif
  if (steps) estimator.step(frame, (flags & kNextFrame) != 0);
  return 0;
}
