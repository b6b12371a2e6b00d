// Recording: LiDAR frames as bytes, for runs without a sensor and a simulator. `tumblesight record` writes
// the files.
//
// Layout, little-endian:
//   offset  size  field
//        0     4  magic "TSLR"
//        4     2  format version (2)
//        6     2  rays per side
//        8     4  frames
//       12     …  the frames, described below
//      end     4  CRC-32 of all bytes before it
// A frame: exposure time (8 bytes, ns), sequence number (4), field of view (4, urad). The chaser's attitude
// at the exposure: 1 if it is known (1 byte), its time (8, ns), quaternion (4 each; w, x, y, z, Q1.30, LRF to
// an inertial frame). Then for every row of rays, from the top: column of the first return (1), number of
// ranges from that column (1), the ranges (2 each, Q9.7 metres). The other rays of the row have no return.
//
// Version 1, which is read too, has no attitudes of the chaser.
#pragma once

#include <cstddef>
#include <cstdint>

#include "gnc/attitude/chaser_attitude.hpp"
#include "gnc/lidar/range_image.hpp"

namespace tumblesight::hal::replay {

inline constexpr std::size_t kRecordingHeaderSize = 12;
inline constexpr std::size_t kRecordingCrcSize = 4;
// Largest size of a frame.
inline constexpr std::size_t kRecordedFrameSize =
    16 + 25 + gnc::RangeImage::kMaxRays * (2 + 2 * gnc::RangeImage::kMaxRays);

enum class RecordingStatus : std::uint8_t {
  kOk = 0,
  kTooShort,    // shorter than header and CRC
  kBadMagic,    // not a recording
  kBadVersion,  // unsupported format version
  kBadCrc,      // the file is damaged
  kBadRays,     // 0 or above RangeImage::kMaxRays
};
const char* to_string(RecordingStatus status);

// Reads the frames of a recording in order. The bytes must outlive the object. No heap.
class Recording {
 public:
  // Checks header and CRC and goes to the first frame. On an error the object stays unchanged.
  [[nodiscard]] RecordingStatus open(const std::uint8_t* bytes, std::size_t size);
  std::uint32_t frames() const { return frames_; }

  // Whether there is another complete and valid frame.
  bool has_next() const { return read_ < frames_ && next_size() > 0; }
  bool was_read() const { return read_ == frames_; }  // all of it
  std::int64_t next_exposure_time_ns() const;         // requires has_next()
  std::uint32_t next_sequence_number() const;         // requires has_next()
  void read_next(gnc::RangeImage& frame);             // requires has_next()
  // At the exposure of the frame that was read last.
  const gnc::ChaserAttitude& chaser_attitude() const { return chaser_; }

 private:
  std::size_t next_size() const;
  std::size_t frame_header_size() const;
  void read_chaser_attitude();

  const std::uint8_t* bytes_ = nullptr;
  std::size_t end_ = 0;  // end of the frames in bytes_
  std::size_t at_ = 0;
  std::uint32_t frames_ = 0;
  std::uint32_t read_ = 0;
  std::uint16_t rays_ = 0;
  bool has_attitudes_ = false;
  gnc::ChaserAttitude chaser_;
};

// To write a recording: each function writes at `out`, which must have room for the sizes above, and returns
// the number of bytes written. All frames must have the same number of rays.
std::size_t write_recording_header(std::uint16_t rays, std::uint32_t frames, std::uint8_t* out);
std::size_t write_recorded_frame(const gnc::RangeImage& frame, const gnc::ChaserAttitude& chaser,
                                 std::uint8_t* out);
std::size_t write_recording_crc(const std::uint8_t* recording, std::size_t size, std::uint8_t* out);

}  // namespace tumblesight::hal::replay
