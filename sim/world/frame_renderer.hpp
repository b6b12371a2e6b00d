// FrameRenderer: the one recipe from a step of a scenario to the frame that the sensor delivers. Simulation,
// recordings, evaluation, training and calibration all use it, so that a sequence looks the same to all of
// them.
//
// FlashLidar::expose makes the ranges, with the settings of the sensor, the condition and the effects, the
// swath of the renderer and a noise seed by the renderer's rule. The stamp adds sequence number and exposure
// time. A frozen sensor shows the frame that it repeats under the stamp of its own.
#pragma once

#include <cstdint>

#include "gnc/lidar/range_image.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {

// The seed of the sensor noise in frame `frame` of a sequence. Results, recordings and trained
// networks are identified by their seeds, so a rule must not change once something has been made with it.
using NoiseSeedRule = std::uint64_t (*)(const Sequence& sequence, std::uint32_t frame);

// The rule: independent noise in every frame.
std::uint64_t noise_seed_per_frame(const Sequence& sequence, std::uint32_t frame);
// The sequence's own seed for every frame. Only for training on single frames (sequences of one frame), with
// which the shipped networks were trained.
std::uint64_t noise_seed_per_sequence(const Sequence& sequence, std::uint32_t frame);

// What the sensor adds to the ranges of a frame to identify it.
struct FrameStamp {
  std::uint32_t sequence_number = 0;
  std::int64_t exposure_time_ns = 0;
};

class FrameRenderer {
 public:
  // `lidar` must outlive the renderer. `swath_m`: side of the square that a frame covers at the target:
  // the swath of the network that will see the frames, or swath_m(mesh).
  FrameRenderer(const FlashLidar& lidar, double swath_m, NoiseSeedRule noise_seed = noise_seed_per_frame)
      : lidar_(lidar), swath_m_(swath_m), noise_seed_(noise_seed) {}

  // Renders frame `frame` (index, must exist) of the sequence into `image`. Thread-safe. The same arguments
  // give the same frame.
  void render(const Sequence& sequence, std::uint32_t frame, const FrameStamp& stamp,
              gnc::RangeImage& image) const;
  // Stamped as the first sequence of a run: number `frame`, at the frame's time in the sequence.
  void render(const Sequence& sequence, std::uint32_t frame, gnc::RangeImage& image) const;

  double swath_m() const { return swath_m_; }

 private:
  const FlashLidar& lidar_;
  double swath_m_;
  NoiseSeedRule noise_seed_;
};

}  // namespace tumblesight::sim
