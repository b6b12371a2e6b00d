// Makes recordings of frames. The frames are added one by one, or rendered from the sequences of a scenario.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "gnc/attitude/chaser_attitude.hpp"
#include "gnc/lidar/range_image.hpp"
#include "sim/recording/truth_file.hpp"
#include "sim/world/frame_renderer.hpp"

namespace tumblesight::sim {

// RecordingWriter: turns frames into the bytes of a recording. hal/replay/recording.hpp has the format.
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

// Renders the sequences of a scenario into a recording.
struct RecordingSettings {
  ScenarioSettings scenario;  // with the number of frames per sequence
  std::uint64_t seed = 1;
  std::uint32_t sequences = 1;
};

struct MadeRecording {
  std::vector<std::uint8_t> bytes;   // of the file
  std::vector<RecordedTruth> truth;  // of each frame
};

// Sequences 0 .. sequences-1 of the seed, with the chaser's attitude at each exposure. Lost frames are left
// out. Ten frames are missing between two sequences, so that the application recognizes the second one as
// new. `progress`: frames done so far.
MadeRecording make_recording(const FrameRenderer& renderer, const RecordingSettings& settings,
                             const std::function<void(std::uint32_t)>& progress);

}  // namespace tumblesight::sim
