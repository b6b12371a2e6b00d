// RecordedSteps: turns recorded frames into steps, at the times at which the flight program would have
// received them on board.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/recording/recording_file.hpp"
#include "sim/recording/step_source.hpp"

namespace tumblesight::sim {

struct RecordedCycle {
  std::int64_t time_ns = 0;
  bool has_frame = false;
};

// One cycle for each frame, at its exposure time. Between frames that are n nominal periods apart (rounded),
// n - 1 cycles without a frame. A frame that was exposed no later than the cycle before it gets a cycle 1 ms
// after that one. Throws std::runtime_error that names frame, value, limit and remedy if an exposure time is
// out of range, or if there are more than a million cycles.
std::vector<RecordedCycle> plan_cycles(const std::vector<FrameStamp>& frames);

class RecordedSteps final : public StepSource {
 public:
  // `truth`: of each frame (truth_by_frame), or empty. A step whose truth is not known says so
  // (StepResult::truth_known). A pause after which the flight program begins a new track begins a new
  // sequence. Range and rate that are not known are NaN. `swath_m`: of FrameTruth::offset_swaths. `recording`
  // and `truth` must outlive the object. Throws as plan_cycles does.
  RecordedSteps(const RecordingFile& recording, const std::vector<std::optional<RecordedTruth>>& truth,
                double swath_m);

  std::uint32_t steps() const override { return static_cast<std::uint32_t>(cycles_.size()); }
  std::int64_t time_ns(std::uint32_t k) const override { return cycles_[k].time_ns; }
  SourcedStep next() override;

 private:
  void take_frame(SourcedStep& sourced);

  const RecordingFile& file_;
  const std::vector<std::optional<RecordedTruth>>& truth_;
  double swath_m_;
  std::vector<RecordedCycle> cycles_;
  hal::replay::Recording recording_;
  std::unique_ptr<gnc::RangeImage> frame_;
  std::size_t next_cycle_ = 0;
  std::size_t next_frame_ = 0;
  std::int64_t last_frame_ns_ = 0;  // cycle time
  std::uint32_t sequence_ = 0;
  std::uint32_t frame_index_ = 0;
};

}  // namespace tumblesight::sim
