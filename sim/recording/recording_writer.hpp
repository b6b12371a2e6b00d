// RecordingWriter: frames as the bytes of a recording. hal/replay/recording.hpp has the format.
#pragma once

#include <cstdint>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "gnc/tracking/chaser_attitude.hpp"

namespace tumblesight::sim {

class RecordingWriter {
 public:
  // `rays` per side of every frame, `frames` in all.
  RecordingWriter(std::uint16_t rays, std::uint32_t frames);

  void add(const gnc::RangeImage& frame, const gnc::ChaserAttitude& chaser);
  // The whole recording, with its CRC. To be called once, after the last frame.
  std::vector<std::uint8_t> finish();

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace tumblesight::sim
