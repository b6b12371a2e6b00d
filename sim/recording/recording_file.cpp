#include "sim/recording/recording_file.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <stdexcept>

namespace tumblesight::sim {
namespace {

using hal::replay::Recording;
using hal::replay::RecordingStatus;

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw std::runtime_error("recording '" + path + "': " + what +
                           "; write it with `tumblesight record` or as docs/icd.md describes");
}

}  // namespace

std::vector<std::uint8_t> read_bytes(const std::string& path) {
  std::error_code error;
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path, error))
    throw std::runtime_error("'" + path + "' cannot be read; give an existing file");
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Recording RecordingFile::open() const {
  Recording recording;
  if (recording.open(bytes.data(), bytes.size()) != RecordingStatus::kOk)
    throw std::logic_error("a recording that was checked cannot be opened");
  return recording;
}

RecordingFile read_recording(const std::string& path) {
  return recording_of(read_bytes(path), path);
}

RecordingFile recording_of(std::vector<std::uint8_t> bytes, const std::string& path) {
  RecordingFile file;
  file.bytes = std::move(bytes);
  Recording recording;
  const RecordingStatus status = recording.open(file.bytes.data(), file.bytes.size());
  if (status != RecordingStatus::kOk) refuse(path, to_string(status));
  const auto frame = std::make_unique<gnc::RangeImage>();
  while (recording.has_next()) {
    file.frames.push_back({recording.next_sequence_number(), recording.next_exposure_time_ns()});
    recording.read_next(*frame);
  }
  if (!recording.was_read())
    refuse(path, "frame " + std::to_string(file.frames.size() + 1) + " of " +
                     std::to_string(recording.frames()) +
                     " is incomplete, or a row has more ranges than rays");
  if (file.frames.empty()) refuse(path, "it has no frames");
  return file;
}

std::vector<std::optional<RecordedTruth>> truth_by_frame(const RecordingFile& recording,
                                                         const TruthTable& truth, const std::string& name) {
  std::vector<std::optional<RecordedTruth>> found;
  std::set<TruthTable::key_type> used;
  for (const FrameStamp& frame : recording.frames) {
    const auto row = truth.find({frame.sequence_number, frame.exposure_time_ns});
    found.push_back(row == truth.end() ? std::nullopt : std::optional(row->second));
    if (row != truth.end()) used.insert(row->first);
  }
  for (const auto& [key, row] : truth) {
    if (used.count(key) != 0) continue;
    throw std::runtime_error(
        name + ", line " + std::to_string(row.line) + ": the recording has no frame with sequence_number " +
        std::to_string(key.first) + " and exposure_time_ns " + std::to_string(key.second) +
        "; give the truth of this recording with --truth, or --truth none");
  }
  return found;
}

}  // namespace tumblesight::sim
