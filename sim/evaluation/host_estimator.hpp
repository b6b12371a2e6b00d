// HostEstimator: the flight estimator in the numerics that a model image is of.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gnc/rcnn/attitude_estimator.hpp"

namespace tumblesight::sim {

class HostEstimator {
 public:
  // `image` must stay. `expected_target`: nullptr to accept any.
  explicit HostEstimator(const std::vector<std::uint8_t>& image, const char* expected_target = nullptr);

  gnc::ModelStatus status() const { return status_; }
  // The rest requires status() to be kOk.
  const gnc::ModelHeader& model() const;
  void reset();
  [[nodiscard]] gnc::FrameStatus step(const gnc::RangeImage& frame, gnc::AttitudeEstimate& estimate);

 private:
  std::unique_ptr<gnc::AttitudeEstimator<gnc::FixedPoint>> fixed_point_;  // one of the two
  std::unique_ptr<gnc::AttitudeEstimator<gnc::Float32>> float32_;
  gnc::ModelStatus status_;
};

}  // namespace tumblesight::sim
