#include "sim/recording/recorded_steps.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>

namespace tumblesight::sim {
namespace {

constexpr std::int64_t kLeastStep_ns = 1'000'000;
constexpr std::int64_t kPause_ns = 8 * kFramePeriod_ns;              // LongestCoast_ms at the start
constexpr std::int64_t kLargestTime_ns = 3'000'000'000'000'000'000;  // 95 years
constexpr std::size_t kMaxCycles = 1'000'000;

[[noreturn]] void refuse(std::size_t frame, const FrameStamp& stamp, const std::string& what) {
  throw std::runtime_error("frame " + std::to_string(frame + 1) + " of the recording, sequence number " +
                           std::to_string(stamp.sequence_number) + ": exposure time " +
                           std::to_string(stamp.exposure_time_ns) + " ns " + what);
}

}  // namespace

std::vector<RecordedCycle> plan_cycles(const std::vector<FrameStamp>& frames) {
  std::vector<RecordedCycle> cycles;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::int64_t exposure_ns = frames[i].exposure_time_ns;
    if (exposure_ns < -kLargestTime_ns || exposure_ns > kLargestTime_ns)
      refuse(i, frames[i],
             "must be from " + std::to_string(-kLargestTime_ns) + " to " + std::to_string(kLargestTime_ns) +
                 " ns; count nanoseconds from any instant of the mission");
    if (!cycles.empty()) {
      const std::int64_t last_ns = cycles.back().time_ns;
      const std::int64_t periods = (exposure_ns - last_ns + kFramePeriod_ns / 2) / kFramePeriod_ns;
      const auto missing = static_cast<std::size_t>(std::max<std::int64_t>(0, periods - 1));
      if (cycles.size() + missing >= kMaxCycles)
        refuse(i, frames[i],
               "is cycle " + std::to_string(cycles.size() + missing + 1) + "; a run has at most " +
                   std::to_string(kMaxCycles) + ": divide the recording, or check its clock");
      for (std::size_t n = 1; n <= missing; ++n)
        cycles.push_back({last_ns + static_cast<std::int64_t>(n) * kFramePeriod_ns, false});
    }
    const std::int64_t earliest_ns = cycles.empty() ? exposure_ns : cycles.back().time_ns + kLeastStep_ns;
    cycles.push_back({std::max(exposure_ns, earliest_ns), true});
  }
  return cycles;
}

RecordedSteps::RecordedSteps(const RecordingFile& recording,
                             const std::vector<std::optional<RecordedTruth>>& truth, double swath_m)
    : file_(recording),
      truth_(truth),
      swath_m_(swath_m),
      cycles_(plan_cycles(recording.frames)),
      recording_(recording.open()),
      frame_(std::make_unique<gnc::RangeImage>()) {}

SourcedStep RecordedSteps::next() {
  const RecordedCycle& cycle = cycles_[next_cycle_++];
  const bool after_pause = next_frame_ > 0 && cycle.time_ns - last_frame_ns_ > kPause_ns;
  if (cycle.has_frame && after_pause) {
    ++sequence_;
    frame_index_ = 0;
  }
  SourcedStep sourced;
  sourced.step.sequence = sequence_;
  sourced.step.frame_index = frame_index_++;
  sourced.step.time_ns = sourced.input.time_ns = cycle.time_ns;
  sourced.step.truth = {Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 0.0};
  sourced.step.truth.lost = true;
  sourced.step.truth_known = false;
  if (cycle.has_frame) take_frame(sourced);
  return sourced;
}

void RecordedSteps::take_frame(SourcedStep& sourced) {
  recording_.read_next(*frame_);
  sourced.input.frames = {frame_.get()};
  if (recording_.chaser_attitude().valid) sourced.input.navigations = {recording_.chaser_attitude()};
  sourced.keep_picture = is_pictured(next_frame_, next_frame_, file_.frames.size());
  FrameTruth& truth = sourced.step.truth;
  truth.lost = false;
  if (next_frame_ < truth_.size() && truth_[next_frame_]) {
    const RecordedTruth& known = *truth_[next_frame_];
    truth.q_lrf_trf = known.q_lrf_trf;
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    const Eigen::Vector3d unknown = Eigen::Vector3d::Constant(kUnknown);
    const Eigen::Vector3d origin_m = known.trf_origin_lrf_m.value_or(unknown);
    truth.rate_lrf_rad_s = known.rate_lrf_rad_s.value_or(unknown);
    truth.range_m = origin_m.y();
    truth.offset_swaths = Eigen::Vector2d(origin_m.x(), origin_m.z()) / swath_m_;
    sourced.step.truth_known = true;
  }
  last_frame_ns_ = sourced.step.time_ns;
  ++next_frame_;
}

}  // namespace tumblesight::sim
