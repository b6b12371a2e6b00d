#include "sim/campaign/sequence_record.hpp"

#include <cstring>
#include <stdexcept>

#include "gnc/numerics/crc.hpp"

namespace tumblesight::sim {
namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "records are little-endian");

constexpr std::size_t kRecordCrcBytes = 4;

// The two directions have the same calls, so that serialise() is the only description of a record.
class Writer {
 public:
  template <typename Number>
  void operator()(const Number& number) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&number);
    bytes_.insert(bytes_.end(), bytes, bytes + sizeof number);
  }
  void operator()(const bool& flag) { bytes_.push_back(flag ? 1 : 0); }
  std::vector<std::uint8_t> bytes_{};
};

class Reader {
 public:
  explicit Reader(const std::uint8_t* bytes) : bytes_(bytes) {}
  template <typename Number>
  void operator()(Number& number) {
    std::memcpy(&number, bytes_, sizeof number);
    bytes_ += sizeof number;
  }
  void operator()(bool& flag) { flag = *bytes_++ != 0; }

 private:
  const std::uint8_t* bytes_;
};

template <typename Archive, typename Quaternion>
void serialise_quaternion(Archive& archive, Quaternion& q) {
  for (int i = 0; i < 4; ++i) archive(q.coeffs()[i]);
}

template <typename Archive, typename Pose>
void serialise_pose(Archive& archive, Pose& pose) {
  archive(pose.known);
  archive(pose.verified);
  archive(pose.turn_deg);
  archive(pose.across_m);
  archive(pose.along_m);
  archive(pose.rate_deg_s);
  archive(pose.velocity_m_s);
  archive(pose.inside_95);
}

template <typename Archive, typename Frame>
void serialise_frame(Archive& archive, Frame& frame) {
  archive(frame.valid);
  archive(frame.owed);
  archive(frame.trusted);
  serialise_quaternion(archive, frame.truth);
  serialise_quaternion(archive, frame.rcnn);
  serialise_quaternion(archive, frame.cnn);
  archive(frame.rcnn_predicted_rad);
  archive(frame.cnn_predicted_rad);
  archive(frame.range_m);
  archive(frame.rate_rad_s);
  archive(frame.has_baseline);
  archive(frame.baseline_valid);
  serialise_quaternion(archive, frame.baseline);
  serialise_pose(archive, frame.pose);
}

std::size_t frame_size_bytes() {
  Writer writer;
  const FrameResult any;
  serialise_frame(writer, any);
  return writer.bytes_.size();
}

std::uint32_t crc_of(const std::uint8_t* bytes, std::size_t size_bytes) {
  return gnc::crc32(bytes, size_bytes);
}

}  // namespace

std::size_t record_size_bytes(std::uint32_t frames) {
  static const std::size_t frame_bytes = frame_size_bytes();
  constexpr std::size_t kFrameFlag = 1;  // whether it was delivered
  return 2 * sizeof(std::uint32_t) + frames * (kFrameFlag + frame_bytes) + 2 * sizeof(double) +
         kRecordCrcBytes;
}

std::vector<std::uint8_t> to_record(std::uint32_t run, const SequenceResult& result, std::uint32_t frames) {
  Writer writer;
  writer(run);
  writer(result.sequence);
  const FrameResult lost;
  std::size_t next = 0;
  for (std::uint32_t k = 0; k < frames; ++k) {
    const bool delivered = next < result.frames.size() && result.frames[next].frame == k;
    writer(delivered);
    serialise_frame(writer, delivered ? result.frames[next++] : lost);
  }
  writer(result.step_ms);
  writer(result.baseline_ms);
  writer(crc_of(writer.bytes_.data(), writer.bytes_.size()));
  return std::move(writer.bytes_);
}

std::uint32_t run_of_record(const std::uint8_t* bytes) {
  std::uint32_t run = 0;
  Reader reader(bytes);
  reader(run);
  return run;
}

std::optional<SequenceResult> from_record(const std::uint8_t* bytes, std::uint32_t frames) {
  const std::size_t content_bytes = record_size_bytes(frames) - kRecordCrcBytes;
  std::uint32_t crc = 0;
  Reader(bytes + content_bytes)(crc);
  if (crc != crc_of(bytes, content_bytes)) return std::nullopt;
  SequenceResult result;
  std::uint32_t run = 0;
  Reader reader(bytes);
  reader(run);
  reader(result.sequence);
  for (std::uint32_t k = 0; k < frames; ++k) {
    bool delivered = false;
    FrameResult frame;
    reader(delivered);
    serialise_frame(reader, frame);
    frame.sequence = result.sequence;
    frame.frame = k;
    if (delivered) result.frames.push_back(frame);
  }
  reader(result.step_ms);
  reader(result.baseline_ms);
  return result;
}

}  // namespace tumblesight::sim
