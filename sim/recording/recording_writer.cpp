#include "sim/recording/recording_writer.hpp"

#include <utility>

#include "hal/replay/recording.hpp"

namespace tumblesight::sim {

RecordingWriter::RecordingWriter(std::uint16_t rays, std::uint32_t frames)
    : bytes_(hal::replay::kRecordingHeaderSize) {
  hal::replay::write_recording_header(rays, frames, bytes_.data());
}

void RecordingWriter::add(const gnc::RangeImage& frame, const gnc::ChaserAttitude& chaser) {
  const std::size_t size = bytes_.size();
  bytes_.resize(size + hal::replay::kRecordedFrameSize);
  bytes_.resize(size + hal::replay::write_recorded_frame(frame, chaser, bytes_.data() + size));
}

std::vector<std::uint8_t> RecordingWriter::finish() {
  const std::size_t size = bytes_.size();
  bytes_.resize(size + hal::replay::kRecordingCrcSize);
  hal::replay::write_recording_crc(bytes_.data(), size, bytes_.data() + size);
  return std::move(bytes_);
}

}  // namespace tumblesight::sim
