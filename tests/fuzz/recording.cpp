// Recordings of any content. A frame that is read must be the same when it is written and read again.
#include "hal/replay/recording.hpp"

#include <limits>
#include <memory>
#include <vector>

#include "hal/replay/replay_inputs.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tumblesight::fuzz {
namespace {

namespace replay = hal::replay;

// Adds a valid header and CRC, so that the frames are reached.
std::vector<std::uint8_t> with_header_and_crc(Input& input) {
  std::vector<std::uint8_t> bytes(replay::kRecordingHeaderSize);
  const auto rays = static_cast<std::uint16_t>(input.u8() + 1);
  replay::write_recording_header(rays, input.u8(), bytes.data());
  bytes.insert(bytes.end(), input.rest(), input.rest() + input.left());
  const std::size_t size = bytes.size();
  bytes.resize(size + replay::kRecordingCrcSize);
  replay::write_recording_crc(bytes.data(), size, bytes.data() + size);
  return bytes;
}

bool equal(const gnc::RangeImage& a, const gnc::RangeImage& b) {
  return a.exposure_time_ns == b.exposure_time_ns && a.sequence_number == b.sequence_number &&
         a.fov_urad == b.fov_urad && a.rays == b.rays && a.ranges == b.ranges;
}

void check_written_again(const gnc::RangeImage& frame, const gnc::ChaserAttitude& chaser) {
  static gnc::RangeImage again;
  std::vector<std::uint8_t> bytes(replay::kRecordingHeaderSize + replay::kRecordedFrameSize +
                                  replay::kRecordingCrcSize);
  std::size_t size = replay::write_recording_header(frame.rays, 1, bytes.data());
  size += replay::write_recorded_frame(frame, chaser, bytes.data() + size);
  size += replay::write_recording_crc(bytes.data(), size, bytes.data() + size);
  replay::Recording recording;
  require(recording.open(bytes.data(), size) == replay::RecordingStatus::kOk, "a written recording is valid");
  require(recording.has_next(), "the recording has the frame");
  recording.read_next(again);
  require(equal(frame, again), "the frame is read as it was written");
  const gnc::ChaserAttitude& read = recording.chaser_attitude();
  require(read.valid == chaser.valid && read.time_ns == chaser.time_ns &&
              read.q_inertial_lrf == chaser.q_inertial_lrf,
          "the attitude of the chaser is read as it was written");
  require(!recording.has_next(), "the recording has no other frame");
}

void read_all(const std::uint8_t* bytes, std::size_t size) {
  static gnc::RangeImage frame;
  replay::Recording recording;
  const replay::RecordingStatus status = recording.open(bytes, size);
  require(replay::to_string(status)[0] != '\0', "a status has a name");
  if (status != replay::RecordingStatus::kOk) return;
  replay::ReplayLidar lidar(recording);
  lidar.advance_to(std::numeric_limits<std::int64_t>::max());
  std::uint32_t frames = 0;
  while (lidar.receive(frame) == hal::LidarStatus::kFrame) {
    require(++frames <= recording.frames(), "there are no more frames than announced");
    if (frames <= 2) check_written_again(frame, recording.chaser_attitude());
  }
}

}  // namespace
}  // namespace tumblesight::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight::fuzz;
  Input input(data, size);
  const bool as_it_is = (input.u8() & 1) != 0;
  const std::vector<std::uint8_t> bytes =
      as_it_is ? std::vector<std::uint8_t>(input.rest(), input.rest() + input.left())
               : with_header_and_crc(input);
  // A copy of exactly the input's size, so that AddressSanitizer sees every byte read beyond it.
  const std::unique_ptr<std::uint8_t[]> exact(new std::uint8_t[bytes.size()]);
  std::copy(bytes.begin(), bytes.end(), exact.get());
  read_all(exact.get(), bytes.size());
  return 0;
}
