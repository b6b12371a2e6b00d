// A small valid recording and every damage of a kind: it is refused by name, or read as far as it is right.
// Nothing crashes, nothing waits, and what the CRC protects is never read differently.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <stdexcept>

#include "hal/replay/replay_inputs.hpp"
#include "sim/recording/mcap_reader.hpp"
#include "sim/recording/mcap_writer.hpp"
#include "sim/recording/recording_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tumblesight::sim {
namespace {

using Bytes = std::vector<std::uint8_t>;
namespace replay = hal::replay;

constexpr std::uint16_t kRays = 4;
constexpr std::uint32_t kFrames = 3;

// Of frames with empty, full and partly filled rows.
Bytes small_recording() {
  Bytes bytes(replay::kRecordingHeaderSize + kFrames * replay::kRecordedFrameSize +
              replay::kRecordingCrcSize);
  std::size_t size = replay::write_recording_header(kRays, kFrames, bytes.data());
  const auto frame = std::make_unique<gnc::RangeImage>();
  frame->rays = kRays;
  frame->fov_urad = 140'000;
  for (std::uint32_t k = 0; k < kFrames; ++k) {
    frame->sequence_number = k;
    frame->exposure_time_ns = std::int64_t{2'700'000'000} * k;
    for (std::size_t i = 0; i < 4; ++i) frame->ranges[kRays + i] = static_cast<std::uint16_t>(6400 + i);
    frame->ranges[2 * kRays + 1] = static_cast<std::uint16_t>(6401 + k);
    size += replay::write_recorded_frame(*frame, {}, bytes.data() + size);
  }
  size += replay::write_recording_crc(bytes.data(), size, bytes.data() + size);
  bytes.resize(size);
  return bytes;
}

void renew_crc(Bytes& bytes) {
  const std::size_t end = bytes.size() - replay::kRecordingCrcSize;
  replay::write_recording_crc(bytes.data(), end, bytes.data() + end);
}

// With a copy of exactly this size, so that a sanitizer sees every byte read beyond it.
std::uint32_t frames_replayed(const Bytes& bytes) {
  const std::unique_ptr<std::uint8_t[]> exact(new std::uint8_t[bytes.size()]);
  std::copy(bytes.begin(), bytes.end(), exact.get());
  replay::Recording recording;
  if (recording.open(exact.get(), bytes.size()) != replay::RecordingStatus::kOk) return 0;
  replay::ReplayLidar lidar(recording);
  lidar.advance_to(std::numeric_limits<std::int64_t>::max());
  const auto frame = std::make_unique<gnc::RangeImage>();
  std::uint32_t frames = 0;
  while (lidar.receive(*frame) == hal::LidarStatus::kFrame) ++frames;
  EXPECT_LE(frames, recording.frames());
  return frames;
}

// The message; empty if it is read. Replayed as well: a lidar of it gives no more frames than it has.
std::string refusal_of(const Bytes& bytes) {
  const std::uint32_t replayed = frames_replayed(bytes);
  try {
    const RecordingFile file = recording_of(bytes, "a.tslr");
    EXPECT_EQ(file.frames.size(), file.open().frames());
    EXPECT_LE(replayed, file.frames.size());
    return {};
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).find("recording 'a.tslr': "), 0U) << error.what();
    return error.what();
  }
}

TEST(MutatedRecording, CutOffAnywhereIsRefused) {
  const Bytes whole = small_recording();
  const TemporaryFolder folder;
  ASSERT_EQ(refusal_of(whole), "");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_NE(refusal_of(cut), "") << size;
    EXPECT_THROW((void)read_recording(folder.put("a.tslr", cut)), std::runtime_error) << size;
    if (size < replay::kRecordingHeaderSize + replay::kRecordingCrcSize) continue;
    renew_crc(cut);  // as a writer that was stopped and went on to the end of the file
    EXPECT_NE(refusal_of(cut), "") << size;
  }
}

TEST(MutatedRecording, WithAnyBitFlippedIsRefused) {
  const Bytes whole = small_recording();
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      Bytes flipped = whole;
      flipped[at] = static_cast<std::uint8_t>(flipped[at] ^ (1U << bit));
      EXPECT_NE(refusal_of(flipped), "") << at << " " << bit;
    }
  }
}

TEST(MutatedRecording, WithAnyByteAtAnExtremeAndAValidChecksumIsRefusedOrReadWhole) {
  const Bytes whole = small_recording();
  const TemporaryFolder folder;
  for (std::size_t at = 0; at < whole.size() - replay::kRecordingCrcSize; ++at) {
    for (const int value : {0, 1, 0x7F, 0x80, 0xFE, 0xFF}) {
      Bytes changed = whole;
      changed[at] = static_cast<std::uint8_t>(value);
      renew_crc(changed);
      const std::string refusal = refusal_of(changed);
      std::string from_file;
      try {
        (void)read_recording(folder.put("a.tslr", changed));
      } catch (const std::runtime_error& error) {
        from_file = error.what();
      }
      EXPECT_EQ(refusal.empty(), from_file.empty()) << at << " " << value << ": " << refusal << from_file;
    }
  }
}

// Two channels with a schema, their messages in a chunk, a summary with indices.
Bytes small_mcap(const TemporaryFolder& folder) {
  const std::string path = folder.path("whole.mcap");
  {
    McapWriter writer(path, "test");
    const McapId type = writer.add_schema("Type", "omgidl", "struct Type { long x; };");
    const McapId first = writer.add_channel("one", "cdr", type);
    const McapId second = writer.add_channel("two", "cdr", type);
    for (std::int64_t k = 0; k < 6; ++k) {
      const Bytes message{1, 2, 3, static_cast<std::uint8_t>(k)};
      writer.write(k % 2 == 0 ? first : second, 1'000'000'000 * k, message.data(), message.size());
    }
    writer.close();
  }
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Bytes of all messages that can be read.
std::vector<Bytes> messages_of(const McapReader& reader) {
  std::vector<Bytes> messages;
  for (const McapReader::Channel& channel : reader.channels()) {
    for (const McapReader::Entry& entry : reader.entries(channel.id)) {
      const McapReader::Message message = reader.read(channel.id, entry);
      messages.emplace_back(message.bytes, message.bytes + message.size);
    }
  }
  return messages;
}

// Reads all, or returns the refusal.
std::string read_mcap(const Bytes& bytes, std::size_t most) {
  try {
    const std::size_t count =
        messages_of(McapReader::from_bytes({bytes.begin(), bytes.end()}, "a.mcap")).size();
    EXPECT_LE(count, most);
    return {};
  } catch (const std::runtime_error& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find("recording 'a.mcap': "), 0U) << message;
    EXPECT_LT(message.size(), 1000U);
    return message;
  }
}

TEST(MutatedMcap, CutOffAnywhereIsRefusedOrReadToItsLastWholeChunk) {
  const TemporaryFolder folder;
  const Bytes whole = small_mcap(folder);
  ASSERT_EQ(read_mcap(whole, 6), "");
  for (std::size_t size = 0; size < whole.size(); ++size)
    (void)read_mcap({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}, 6);
}

TEST(MutatedMcap, WithAnyByteChangedIsRefusedOrRead) {
  const TemporaryFolder folder;
  const Bytes whole = small_mcap(folder);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const int value : {0x00, 0x01, 0x7F, 0x80, 0xFF, whole[at] ^ 1, whole[at] ^ 0x80}) {
      Bytes changed = whole;
      changed[at] = static_cast<std::uint8_t>(value);
      (void)read_mcap(changed, whole.size());
    }
  }
}

// Every place, so that every length, offset and count has been each of them.
TEST(MutatedMcap, WithExtremeLengthsIsRefusedOrRead) {
  const TemporaryFolder folder;
  const Bytes whole = small_mcap(folder);
  for (const std::uint64_t extreme :
       {std::uint64_t{0}, std::uint64_t{0x7FFFFFFF}, std::uint64_t{0xFFFFFFFF}, ~std::uint64_t{0} >> 1,
        ~std::uint64_t{0}, ~std::uint64_t{0} - 8, std::uint64_t{whole.size()}}) {
    for (const std::size_t bytes : {4U, 8U}) {
      for (std::size_t at = 0; at + bytes <= whole.size(); ++at) {
        Bytes changed = whole;
        for (std::size_t i = 0; i < bytes; ++i)
          changed[at + i] = static_cast<std::uint8_t>(extreme >> (8 * i));
        (void)read_mcap(changed, whole.size());
      }
    }
  }
}

RecordedTruth truth_of(std::uint32_t number) {
  RecordedTruth truth;
  truth.sequence_number = number;
  truth.exposure_time_ns = std::int64_t{2'700'000'000} * number;
  truth.q_lrf_trf = Eigen::Quaterniond(0.1, -0.7, 1.0 / 3.0, 0.6).normalized();
  truth.rate_lrf_rad_s = {0.01, -0.02, 0.03};
  truth.trf_origin_lrf_m = {0.0, 50.0, 1.0};
  truth.target = "craft";
  truth.sensor = RecordedSensor{"paper", 0x12345678};
  return truth;
}

// The rows; none: refused by name and line.
std::size_t rows_of(const std::string& text) {
  try {
    return parse_truth(text, "a.csv").size();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).find("a.csv, line "), 0U) << error.what();
    EXPECT_LT(std::string(error.what()).size(), 1000U);
    return 0;
  }
}

TEST(MutatedTruth, CutOffOrWithAnyByteChangedIsRefusedOrRead) {
  const std::string whole = truth_csv({truth_of(0), truth_of(1)});
  ASSERT_EQ(rows_of(whole), 2U);
  for (std::size_t size = 0; size < whole.size(); ++size) EXPECT_LE(rows_of(whole.substr(0, size)), 2U);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char value : {'\0', '\n', ',', '-', '9', '.', 'e', ' ', '\xFF'}) {
      std::string changed = whole;
      changed[at] = value;
      EXPECT_LE(rows_of(changed), 3U);
    }
  }
}

TEST(MutatedTruth, OfExtremeNumbersAndLengthsIsRefused) {
  const std::string whole = truth_csv({truth_of(1)});
  const std::size_t end = whole.find('\n');
  const std::string header = whole.substr(0, end + 1), row = whole.substr(end + 1);
  for (const std::string value : {"1e999", "-1e999", "nan", "inf", "99999999999999999999", "0x1p3", ""})
    EXPECT_EQ(rows_of(header + value + row.substr(row.find(','))), 0U) << value;
  EXPECT_EQ(rows_of(header + std::string(1'000'000, '9') + row.substr(row.find(','))), 0U);
  EXPECT_EQ(rows_of(header + std::string(1'000'000, ',')), 0U);
  EXPECT_EQ(rows_of(std::string(1'000'000, ',')), 0U);
  EXPECT_EQ(rows_of(header + std::string(1'000'000, '\n')), 0U);
}

}  // namespace
}  // namespace tumblesight::sim
