// HostEstimator: the way of a frame in flight, on the ground: gnc::FrameTracker with its estimator, in the
// numerics of the given model image (fixed point or float32).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gnc/estimation/attitude_estimator.hpp"
#include "gnc/estimation/frame_tracker.hpp"

namespace tumblesight::sim {

class HostEstimator {
 public:
  // `image` must outlive this object. `expected_target`: the target that the image must be for; nullptr: any.
  explicit HostEstimator(const std::vector<std::uint8_t>& image, const char* expected_target = nullptr);

  gnc::ModelStatus status() const { return status_; }
  // The functions below require status() to be kOk.
  const gnc::ModelHeader& model() const;
  // As at the start of the flight program.
  void reset();
  // One frame in a cycle at the time of its exposure, with the limits of the flight program.
  // `chaser`: its attitude at the exposure.
  gnc::FrameOutcome step(const gnc::RangeImage& frame, const gnc::ChaserAttitude& chaser);

 private:
  std::unique_ptr<gnc::AttitudeEstimator<gnc::FixedPoint>> fixed_point_;  // one of the two
  std::unique_ptr<gnc::AttitudeEstimator<gnc::Float32>> float32_;
  gnc::FrameTrackerState state_;
  gnc::ModelStatus status_;
};

}  // namespace tumblesight::sim
