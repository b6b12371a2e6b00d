// Recording: LiDAR frames as bytes, to be flown again where no sensor and no simulator is.
//
// Layout, little-endian:
//   offset  size  field
//        0     4  magic "TSLR"
//        4     2  format version (1)
//        6     2  rays to a side
//        8     4  frames
//       12     …  the frames
//      end     4  CRC-32 of all before
// A frame: exposure time (8, ns), sequence number (4), field of view (4, urad); then for every row of rays,
// top first: column of its first return (1), number of ranges from there on (1), these ranges (2 each, Q9.7
// m). The row's other rays had no return.
#pragma once

#include <cstddef>
#include <cstdint>

#include "gnc/lidar/range_image.hpp"

namespace tumblesight::hal::replay {

inline constexpr std::size_t kRecordingHeaderSize = 12;
inline constexpr std::size_t kRecordingCrcSize = 4;
// At most, of a frame.
inline constexpr std::size_t kRecordedFrameSize =
    16 + gnc::RangeImage::kMaxRays * (2 + 2 * gnc::RangeImage::kMaxRays);

enum class RecordingStatus : std::uint8_t {
  kOk = 0,
  kTooShort,    // fewer bytes than header and CRC
  kBadMagic,    // not a recording
  kBadVersion,  // of a format this program does not read
  kBadCrc,      // damaged
  kBadRays,     // none, or more than a RangeImage holds
};
const char* to_string(RecordingStatus status);

// Reads frames in order. The bytes must outlive it.
class Recording {
 public:
  [[nodiscard]] RecordingStatus open(const std::uint8_t* bytes, std::size_t size);
  std::uint32_t frames() const { return frames_; }

  // Whether there is another frame, whole and possible.
  bool has_next() const { return read_ < frames_ && next_size() > 0; }
  std::int64_t next_exposure_time_ns() const;  // requires has_next()
  void read_next(gnc::RangeImage& frame);      // requires has_next()

 private:
  std::size_t next_size() const;

  const std::uint8_t* bytes_ = nullptr;
  std::size_t end_ = 0;  // of the frames
  std::size_t at_ = 0;
  std::uint32_t frames_ = 0;
  std::uint32_t read_ = 0;
  std::uint16_t rays_ = 0;
};

// For who makes one: each writes at `out`, which has room for the sizes above, and gives the bytes written.
// All frames have the same number of rays.
std::size_t write_recording_header(std::uint16_t rays, std::uint32_t frames, std::uint8_t* out);
std::size_t write_recorded_frame(const gnc::RangeImage& frame, std::uint8_t* out);
std::size_t write_recording_crc(const std::uint8_t* recording, std::size_t size, std::uint8_t* out);

}  // namespace tumblesight::hal::replay
