#include "sim/recording/make_recording.hpp"

#include <memory>

#include "sim/recording/recording_writer.hpp"

namespace tumblesight::sim {
namespace {

// Between two sequences: longer than the application's track coasts, since they show different motions.
constexpr std::int64_t kPause_frames = 10;

}  // namespace

std::vector<std::uint8_t> make_recording(const FrameRenderer& renderer, const RecordingSettings& settings,
                                         const std::function<void(std::uint32_t)>& progress) {
  const auto frames = static_cast<std::uint32_t>(settings.scenario.frames);
  const int rays = sensor_settings(settings.scenario.condition).rays;
  RecordingWriter writer(static_cast<std::uint16_t>(rays), settings.sequences * frames);
  const auto image = std::make_unique<gnc::RangeImage>();
  for (std::uint32_t i = 0; i < settings.sequences; ++i) {
    const Sequence sequence = make_sequence(settings.scenario, settings.seed, i);
    for (std::uint32_t k = 0; k < frames; ++k) {
      const std::uint32_t number = i * frames + k;
      renderer.render(sequence, k, {number, kFramePeriod_ns * (number + kPause_frames * i)}, *image);
      writer.add(*image);
      progress(number + 1);
    }
  }
  return writer.finish();
}

}  // namespace tumblesight::sim
