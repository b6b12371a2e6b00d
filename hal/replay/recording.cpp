#include "hal/replay/recording.hpp"

#include <cstring>

#include "gnc/numerics/crc.hpp"

namespace tumblesight::hal::replay {
namespace {

constexpr char kMagic[4] = {'T', 'S', 'L', 'R'};
constexpr std::uint16_t kVersion = 2;
constexpr std::uint16_t kVersionWithoutAttitudes = 1;
constexpr std::size_t kFrameHeaderSize = 16;
constexpr std::size_t kAttitudeSize = 25;
constexpr std::size_t kRowHeaderSize = 2;

std::uint64_t get(const std::uint8_t* from, int bytes) {
  std::uint64_t value = 0;
  for (int i = bytes - 1; i >= 0; --i) value = (value << 8) | from[i];
  return value;
}

std::size_t put(std::uint64_t value, int bytes, std::uint8_t* to) {
  for (int i = 0; i < bytes; ++i) to[i] = static_cast<std::uint8_t>(value >> (8 * i));
  return static_cast<std::size_t>(bytes);
}

}  // namespace

const char* to_string(RecordingStatus status) {
  switch (status) {
    case RecordingStatus::kOk:
      return "ok";
    case RecordingStatus::kTooShort:
      return "shorter than a recording's header";
    case RecordingStatus::kBadMagic:
      return "not a recording";
    case RecordingStatus::kBadVersion:
      return "a recording of another version";
    case RecordingStatus::kBadCrc:
      return "a damaged recording";
    case RecordingStatus::kBadRays:
      return "impossible number of rays per side";
  }
  return "unknown";
}

RecordingStatus Recording::open(const std::uint8_t* bytes, std::size_t size) {
  if (size < kRecordingHeaderSize + kRecordingCrcSize) return RecordingStatus::kTooShort;
  if (std::memcmp(bytes, kMagic, sizeof kMagic) != 0) return RecordingStatus::kBadMagic;
  const std::uint64_t version = get(bytes + 4, 2);
  if (version != kVersion && version != kVersionWithoutAttitudes) return RecordingStatus::kBadVersion;
  const std::size_t end = size - kRecordingCrcSize;
  if (gnc::crc32(bytes, end) != get(bytes + end, 4)) return RecordingStatus::kBadCrc;
  const std::uint64_t rays = get(bytes + 6, 2);
  if (rays < 1 || rays > gnc::RangeImage::kMaxRays) return RecordingStatus::kBadRays;
  bytes_ = bytes;
  end_ = end;
  at_ = kRecordingHeaderSize;
  rays_ = static_cast<std::uint16_t>(rays);
  frames_ = static_cast<std::uint32_t>(get(bytes + 8, 4));
  read_ = 0;
  has_attitudes_ = version == kVersion;
  chaser_ = {};
  return RecordingStatus::kOk;
}

std::size_t Recording::frame_header_size() const {
  return has_attitudes_ ? kFrameHeaderSize + kAttitudeSize : kFrameHeaderSize;
}

// Bytes of the next frame. 0 if it exceeds the recording, or one of its rows the frame.
std::size_t Recording::next_size() const {
  std::size_t at = at_ + frame_header_size();
  for (int row = 0; row < rays_; ++row) {
    if (at + kRowHeaderSize > end_ || bytes_[at] + bytes_[at + 1] > rays_) return 0;
    at += kRowHeaderSize + 2U * bytes_[at + 1];
  }
  return at <= end_ ? at - at_ : 0;
}

std::int64_t Recording::next_exposure_time_ns() const {
  return static_cast<std::int64_t>(get(bytes_ + at_, 8));
}

std::uint32_t Recording::next_sequence_number() const {
  return static_cast<std::uint32_t>(get(bytes_ + at_ + 8, 4));
}

void Recording::read_chaser_attitude() {
  const std::uint8_t* from = bytes_ + at_ + kFrameHeaderSize;
  chaser_.valid = from[0] == 1;
  chaser_.time_ns = static_cast<std::int64_t>(get(from + 1, 8));
  for (std::size_t i = 0; i < chaser_.q_inertial_lrf.size(); ++i)
    chaser_.q_inertial_lrf[i] =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(get(from + 9 + 4 * i, 4)));
}

void Recording::read_next(gnc::RangeImage& frame) {
  frame.exposure_time_ns = next_exposure_time_ns();
  frame.sequence_number = next_sequence_number();
  frame.fov_urad = static_cast<std::uint32_t>(get(bytes_ + at_ + 12, 4));
  frame.rays = rays_;
  frame.ranges.fill(0);
  if (has_attitudes_) read_chaser_attitude();
  at_ += frame_header_size();
  for (int row = 0; row < rays_; ++row) {
    std::uint16_t* const first = frame.ranges.data() + row * rays_ + bytes_[at_];
    const int count = bytes_[at_ + 1];
    at_ += kRowHeaderSize;
    for (int i = 0; i < count; ++i) first[i] = static_cast<std::uint16_t>(get(bytes_ + at_ + 2 * i, 2));
    at_ += 2U * static_cast<std::size_t>(count);
  }
  ++read_;
}

std::size_t write_recording_header(std::uint16_t rays, std::uint32_t frames, std::uint8_t* out) {
  std::memcpy(out, kMagic, sizeof kMagic);
  put(kVersion, 2, out + 4);
  put(rays, 2, out + 6);
  put(frames, 4, out + 8);
  return kRecordingHeaderSize;
}

std::size_t write_recorded_frame(const gnc::RangeImage& frame, const gnc::ChaserAttitude& chaser,
                                 std::uint8_t* out) {
  std::uint8_t* to = out;
  to += put(static_cast<std::uint64_t>(frame.exposure_time_ns), 8, to);
  to += put(frame.sequence_number, 4, to);
  to += put(frame.fov_urad, 4, to);
  to += put(chaser.valid ? 1 : 0, 1, to);
  to += put(static_cast<std::uint64_t>(chaser.time_ns), 8, to);
  for (const std::int32_t part : chaser.q_inertial_lrf) to += put(static_cast<std::uint32_t>(part), 4, to);
  for (int row = 0; row < frame.rays; ++row) {
    const std::uint16_t* const ranges = frame.ranges.data() + row * frame.rays;
    int first = 0;
    int end = frame.rays;
    while (first < end && ranges[first] == 0) ++first;
    while (end > first && ranges[end - 1] == 0) --end;
    if (first == end) first = end = 0;
    to += put(static_cast<std::uint64_t>(first), 1, to);
    to += put(static_cast<std::uint64_t>(end - first), 1, to);
    for (int i = first; i < end; ++i) to += put(ranges[i], 2, to);
  }
  return static_cast<std::size_t>(to - out);
}

std::size_t write_recording_crc(const std::uint8_t* recording, std::size_t size, std::uint8_t* out) {
  return put(gnc::crc32(recording, size), 4, out);
}

}  // namespace tumblesight::hal::replay
