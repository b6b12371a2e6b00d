// HostEstimator: the flight estimator on the ground, in the numerics of the given model image (fixed point or
// float32).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gnc/rcnn/attitude_estimator.hpp"

namespace tumblesight::sim {

class HostEstimator {
 public:
  // `image` must outlive this object. `expected_target`: the target that the image must be for; nullptr: any.
  explicit HostEstimator(const std::vector<std::uint8_t>& image, const char* expected_target = nullptr);

  gnc::ModelStatus status() const { return status_; }
  // The functions below require status() to be kOk. They are those of gnc::AttitudeEstimator.
  const gnc::ModelHeader& model() const;
  void reset();
  [[nodiscard]] gnc::FrameStatus step(const gnc::RangeImage& frame, gnc::AttitudeEstimate& estimate);

 private:
  std::unique_ptr<gnc::AttitudeEstimator<gnc::FixedPoint>> fixed_point_;  // one of the two
  std::unique_ptr<gnc::AttitudeEstimator<gnc::Float32>> float32_;
  gnc::ModelStatus status_;
};

}  // namespace tumblesight::sim
