#include "sim/evaluation/host_estimator.hpp"

namespace tumblesight::sim {

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
}

gnc::FrameStatus HostEstimator::step(const gnc::RangeImage& frame, gnc::AttitudeEstimate& estimate) {
  return float32_ ? float32_->step(frame, estimate) : fixed_point_->step(frame, estimate);
}

}  // namespace tumblesight::sim
