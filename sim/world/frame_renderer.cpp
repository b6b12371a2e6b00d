#include "sim/world/frame_renderer.hpp"

#include "sim/world/math/random.hpp"

namespace tumblesight::sim {

std::uint64_t noise_seed_per_frame(const Sequence& sequence, std::uint32_t frame) {
  return mix(sequence.noise_seed, frame);
}

std::uint64_t noise_seed_per_sequence(const Sequence& sequence, std::uint32_t) {
  return sequence.noise_seed;
}

void FrameRenderer::render(const Sequence& sequence, std::uint32_t frame, const FrameStamp& stamp,
                           gnc::RangeImage& image) const {
  const std::uint32_t shown = frame - sequence.frames[frame].frozen_for;
  lidar_.expose(sequence.frames[shown],
                sensor_settings(sequence.condition, sequence.effects, sequence.sensor), swath_m_,
                noise_seed_(sequence, shown), image);
  image.sequence_number = stamp.sequence_number;
  image.exposure_time_ns = stamp.exposure_time_ns;
}

void FrameRenderer::render(const Sequence& sequence, std::uint32_t frame, gnc::RangeImage& image) const {
  render(sequence, frame, {frame, sequence.frames[frame].time_ns}, image);
}

}  // namespace tumblesight::sim
