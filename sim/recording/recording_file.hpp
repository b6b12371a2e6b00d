// Reads a recording of frames from a file. hal/replay/recording.hpp has the format.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/replay/recording.hpp"
#include "sim/recording/truth_file.hpp"
#include "sim/world/frame_renderer.hpp"

namespace tumblesight::sim {

struct RecordingFile {
  std::vector<std::uint8_t> bytes;
  std::vector<FrameStamp> frames;  // in the order of the file

  // At the first frame. The object must outlive it.
  hal::replay::Recording open() const;
};

// Reads the file and every frame in it. Throws std::runtime_error that names file, reason and remedy if it is
// no recording, is damaged, has no frame, or has fewer frames than its header says. A file that is no
// recording, or a damaged one, is not loaded into memory.
RecordingFile read_recording(const std::string& path);
// The same for bytes that will be written to `path`, or were read from it.
RecordingFile recording_of(std::vector<std::uint8_t> bytes, const std::string& path);

// The truth of each frame, in the order of the recording; nothing where the table has no row. Throws
// std::runtime_error that names file, line and remedy if a row belongs to no frame. `name`: of the truth's
// file, for messages.
std::vector<std::optional<RecordedTruth>> truth_by_frame(const RecordingFile& recording,
                                                         const TruthTable& truth, const std::string& name);

}  // namespace tumblesight::sim
