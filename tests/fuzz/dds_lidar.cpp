// Samples of topic sil/lidar_frame with any content, put in and received in any order. Frames are delivered
// unchanged, oldest first, and a sample that is not a frame is reported as such.
#include "hal/dds/dds_lidar.hpp"

#include <cstring>
#include <deque>
#include <memory>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

namespace tumblesight::fuzz {
namespace {

namespace dds = hal::dds;

constexpr int kMostCalls = 200;
constexpr std::size_t kQueue = 2 * dds::kMaxFramesPerStep;

constexpr std::size_t kRanges = gnc::RangeImage::kMaxReturns;

// The fields of a sample; `ranges` is the offset of its ranges in the numbers of some_ranges().
struct Sent {
  std::uint32_t sequence_number;
  std::int64_t exposure_time_ns;
  std::uint32_t fov_urad;
  std::uint16_t rays;
  std::uint8_t ranges;
};

const std::uint16_t* some_ranges(const Sent& sent) {
  static const auto numbers = [] {
    std::vector<std::uint16_t> made(kRanges + 256);
    for (std::size_t i = 0; i < made.size(); ++i) made[i] = static_cast<std::uint16_t>(i * 40503U >> 3);
    return made;
  }();
  return numbers.data() + sent.ranges;
}

dds::LidarFrameSample& sample_of(const Sent& sent) {
  static dds::LidarFrameSample sample;
  sample.sequence_number = sent.sequence_number;
  sample.exposure_time_ns = sent.exposure_time_ns;
  sample.fov_urad = sent.fov_urad;
  sample.rays = sent.rays;
  std::memcpy(sample.ranges, some_ranges(sent), sizeof sample.ranges);
  return sample;
}

bool is_as_sent(const gnc::RangeImage& frame, const Sent& sent) {
  return frame.sequence_number == sent.sequence_number && frame.exposure_time_ns == sent.exposure_time_ns &&
         frame.fov_urad == sent.fov_urad && frame.rays == sent.rays &&
         std::memcmp(frame.ranges.data(), some_ranges(sent), sizeof frame.ranges) == 0;
}

void check_received(dds::DdsLidar& lidar, std::deque<Sent>& waiting) {
  static gnc::RangeImage frame;
  const hal::LidarStatus status = lidar.receive(frame);
  if (waiting.empty()) return require(status == hal::LidarStatus::kNoFrame, "an empty queue gives no frame");
  const Sent sent = waiting.front();
  waiting.pop_front();
  const bool is_frame = sent.rays >= 1 && sent.rays <= gnc::RangeImage::kMaxRays;
  require(status == (is_frame ? hal::LidarStatus::kFrame : hal::LidarStatus::kWrongSize),
          "frames and other samples are distinguished");
  if (is_frame) require(is_as_sent(frame, sent), "the oldest frame is delivered unchanged");
}

}  // namespace
}  // namespace tumblesight::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  using namespace tumblesight::fuzz;
  static const auto lidar = std::make_unique<dds::DdsLidar>();
  std::deque<Sent> waiting;
  Input input(data, size);
  for (int i = 0; i < kMostCalls && !input.empty(); ++i) {
    const std::uint8_t call = input.u8();
    if ((call & 1) != 0) {
      check_received(*lidar, waiting);
      continue;
    }
    Sent sent{input.u32(), static_cast<std::int64_t>(input.u64()), input.u32(), input.u16(), input.u8()};
    if ((call & 2) != 0) sent.rays %= 130;
    lidar->put(sample_of(sent));
    if (waiting.size() == kQueue) waiting.pop_front();
    waiting.push_back(sent);
  }
  while (!waiting.empty()) check_received(*lidar, waiting);
  check_received(*lidar, waiting);
  return 0;
}
