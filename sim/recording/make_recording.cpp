#include "sim/recording/make_recording.hpp"

#include <memory>
#include <utility>

#include "hal/replay/recording.hpp"
#include "sim/world/chaser_navigation.hpp"
#include "sim/world/sensor/ray_effects.hpp"

namespace tumblesight::sim {

RecordingWriter::RecordingWriter(std::uint16_t rays, std::uint32_t frames)
    : bytes_(hal::replay::kRecordingHeaderSize) {
  hal::replay::write_recording_header(rays, frames, bytes_.data());
}

void RecordingWriter::add(const gnc::RangeImage& frame, const gnc::ChaserAttitude& chaser) {
  const std::size_t size = bytes_.size();
  bytes_.resize(size + hal::replay::kRecordedFrameSize);
  bytes_.resize(size + hal::replay::write_recorded_frame(frame, chaser, bytes_.data() + size));
}

std::vector<std::uint8_t> RecordingWriter::finish() {
  const std::size_t size = bytes_.size();
  bytes_.resize(size + hal::replay::kRecordingCrcSize);
  hal::replay::write_recording_crc(bytes_.data(), size, bytes_.data() + size);
  return std::move(bytes_);
}

namespace {

// Between two sequences: longer than the application's track coasts, since they show different motions.
constexpr std::int64_t kPause_frames = 10;

std::uint32_t delivered_frames(const std::vector<Sequence>& sequences) {
  std::uint32_t count = 0;
  for (const Sequence& sequence : sequences) {
    for (const FrameTruth& frame : sequence.frames) count += frame.lost ? 0 : 1;
  }
  return count;
}

RecordedTruth recorded_truth(const FrameTruth& truth, const FrameStamp& stamp, double swath_m) {
  RecordedTruth row;
  row.sequence_number = stamp.sequence_number;
  row.exposure_time_ns = stamp.exposure_time_ns;
  row.q_lrf_trf = truth.q_lrf_trf;
  row.rate_lrf_rad_s = truth.rate_lrf_rad_s;
  const Eigen::Vector2d offset_m = swath_m * truth.offset_swaths;
  row.trf_origin_lrf_m = {offset_m.x(), truth.range_m, offset_m.y()};
  return row;
}

}  // namespace

MadeRecording make_recording(const FrameRenderer& renderer, const RecordingSettings& settings,
                             const std::function<void(std::uint32_t)>& progress) {
  std::vector<Sequence> sequences;
  for (std::uint32_t i = 0; i < settings.sequences; ++i)
    sequences.push_back(make_sequence(settings.scenario, settings.seed, i));
  const ScenarioSettings& scenario = settings.scenario;
  const int rays = frame_rays(sensor_settings(scenario.condition, scenario.effects.high, scenario.sensor));
  const bool ego_motion = !settings.scenario.disturbances.no_ego_motion;
  RecordingWriter writer(static_cast<std::uint16_t>(rays), delivered_frames(sequences));
  MadeRecording made;
  const auto image = std::make_unique<gnc::RangeImage>();
  std::int64_t start_ns = 0;
  std::uint32_t number = 0;
  for (const Sequence& sequence : sequences) {
    for (std::uint32_t k = 0; k < sequence.frames.size(); ++k, ++number) {
      const FrameTruth& truth = sequence.frames[k];
      const FrameStamp stamp{number, start_ns + truth.time_ns};
      if (!truth.lost) {
        renderer.render(sequence, k, stamp, *image);
        writer.add(*image, chaser_attitude(truth, stamp.exposure_time_ns, ego_motion));
        made.truth.push_back(recorded_truth(truth, stamp, renderer.swath_m()));
      }
      progress(number + 1);
    }
    start_ns += sequence.frames.back().time_ns + (1 + kPause_frames) * kFramePeriod_ns;
  }
  made.bytes = writer.finish();
  return made;
}

}  // namespace tumblesight::sim
