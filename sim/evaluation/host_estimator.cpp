#include "sim/evaluation/host_estimator.hpp"

#include "sim/evaluation/flight_limits.hpp"

namespace tumblesight::sim {
namespace {

template <class N>
gnc::FrameOutcome step_of(gnc::AttitudeEstimator<N>& estimator, const gnc::RangeImage& frame,
                          const gnc::ChaserAttitude& chaser, gnc::FrameTrackerState& state) {
  gnc::FrameOutcome outcome;
  gnc::FrameTracker<N>(estimator).step({frame, chaser, chaser, frame.exposure_time_ns}, kFlightLimits, state,
                                       outcome);
  return outcome;
}

}  // namespace

HostEstimator::HostEstimator(const std::vector<std::uint8_t>& image, const char* expected_target) {
  if (gnc::is_float32(image.data(), image.size())) {
    float32_ = std::make_unique<gnc::AttitudeEstimator<gnc::Float32>>();
    status_ = float32_->load(image.data(), image.size(), expected_target);
  } else {
    fixed_point_ = std::make_unique<gnc::AttitudeEstimator<gnc::FixedPoint>>();
    status_ = fixed_point_->load(image.data(), image.size(), expected_target);
  }
}

const gnc::ModelHeader& HostEstimator::model() const {
  return float32_ ? float32_->model() : fixed_point_->model();
}

void HostEstimator::reset() {
  float32_ ? float32_->reset() : fixed_point_->reset();
  state_ = {};
}

gnc::FrameOutcome HostEstimator::step(const gnc::RangeImage& frame, const gnc::ChaserAttitude& chaser) {
  return float32_ ? step_of(*float32_, frame, chaser, state_) : step_of(*fixed_point_, frame, chaser, state_);
}

}  // namespace tumblesight::sim
