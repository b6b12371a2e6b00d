// FrameFaults: sensor faults injected during a run. They change, drop or delay frames between the simulated
// sensor and the flight program.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/sil/sil_session.hpp"
#include "sim/world/sensor/frame_truth.hpp"

namespace tumblesight::sim {

class FrameFaults {
 public:
  enum class Kind {
    kDrop,    // no frame
    kFreeze,  // the ranges of the frame before, under new numbers and times
    kDelay,   // each frame a step late
  };

  // Injects a fault into the next steps, at least 1. It replaces the fault that is active.
  void begin(Kind kind, std::uint32_t steps);
  // Changes what a step sends, and what the truth says of the frame. The frames in `input` are valid until
  // the next call.
  void apply(StepInput& input, FrameTruth& truth);

 private:
  Kind kind_ = Kind::kDrop;
  std::uint32_t left_ = 0;        // steps
  std::uint32_t frozen_for_ = 0;  // frames
  bool has_last_ = false;
  gnc::RangeImage last_{};               // that was sent
  std::deque<gnc::RangeImage> delayed_;  // that wait for a later step
  std::deque<gnc::RangeImage> shown_;    // of this step
};

// "drop", "freeze", "delay". False: no fault has this name.
[[nodiscard]] bool read_fault(const std::string& name, FrameFaults::Kind& kind);

}  // namespace tumblesight::sim
