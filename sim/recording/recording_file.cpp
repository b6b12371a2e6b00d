#include "sim/recording/recording_file.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>

#include "gnc/numerics/crc.hpp"
#include "sim/host/input_file.hpp"

namespace tumblesight::sim {
namespace {

using hal::replay::Recording;
using hal::replay::RecordingStatus;

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw std::runtime_error("recording '" + path + "': " + what +
                           "; write it with `tumblesight record` or as docs/icd.md describes");
}

// As long as its frames make it: the checks below are made before it is loaded.
constexpr InputKind kRecording{"recording", std::numeric_limits<std::uint64_t>::max()};
constexpr std::size_t kBlockBytes = 1U << 20;

// The checks of Recording::open() that need no frame in memory, and the size that the header allows.
RecordingStatus status_of_start(const InputFile& file, const std::string& path) {
  std::array<std::uint8_t, hal::replay::kRecordingHeaderSize + hal::replay::kRecordingCrcSize> start{};
  Recording recording;
  if (file.read_at(0, start.data(), start.size()) < start.size()) return RecordingStatus::kTooShort;
  // Alone with its own CRC, a valid header is a recording.
  hal::replay::write_recording_crc(start.data(), hal::replay::kRecordingHeaderSize,
                                   start.data() + hal::replay::kRecordingHeaderSize);
  const RecordingStatus status = recording.open(start.data(), start.size());
  if (status != RecordingStatus::kOk) return status;
  const std::uint64_t most =
      start.size() + recording.frames() * std::uint64_t{hal::replay::kRecordedFrameSize};
  if (file.size() > most)
    refuse(path, "it has " + std::to_string(file.size()) + " bytes, and its " +
                     std::to_string(recording.frames()) + " frames have at most " + std::to_string(most));
  return status;
}

std::array<std::uint8_t, 4> little_endian(std::uint32_t value) {
  return {static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8),
          static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 24)};
}

// Block by block.
bool fits_its_checksum(const InputFile& file) {
  std::vector<std::uint8_t> block(kBlockBytes);
  gnc::Crc32 crc;
  const std::uint64_t end = file.size() - hal::replay::kRecordingCrcSize;
  for (std::uint64_t at = 0; at < end; at += block.size()) {
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), end - at));
    if (file.read_at(at, block.data(), wanted) < wanted) return false;
    crc.add(block.data(), wanted);
  }
  std::array<std::uint8_t, hal::replay::kRecordingCrcSize> stored{};
  (void)file.read_at(end, stored.data(), stored.size());
  return stored == little_endian(crc.value());
}

}  // namespace

Recording RecordingFile::open() const {
  Recording recording;
  if (recording.open(bytes.data(), bytes.size()) != RecordingStatus::kOk)
    throw std::logic_error("a recording that was checked cannot be opened");
  return recording;
}

RecordingFile read_recording(const std::string& path) {
  const InputFile file(path, kRecording);
  const RecordingStatus status = status_of_start(file, path);
  if (status != RecordingStatus::kOk) refuse(path, to_string(status));
  if (!fits_its_checksum(file)) refuse(path, to_string(RecordingStatus::kBadCrc));
  return recording_of(file.bytes(), path);
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
