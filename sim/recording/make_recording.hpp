// Renders the sequences of a scenario into a recording.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sim/world/frame_renderer.hpp"

namespace tumblesight::sim {

struct RecordingSettings {
  ScenarioSettings scenario;  // with the number of frames per sequence
  std::uint64_t seed = 1;
  std::uint32_t sequences = 1;
};

// Sequences 0 .. sequences-1 of the seed, with the chaser's attitude at each exposure. Lost frames are not in
// it. Between two sequences two frames are missing, so that the application recognizes the second one as new.
// `progress`: frames done so far. Returns the bytes of the file.
std::vector<std::uint8_t> make_recording(const FrameRenderer& renderer, const RecordingSettings& settings,
                                         const std::function<void(std::uint32_t)>& progress);

}  // namespace tumblesight::sim
