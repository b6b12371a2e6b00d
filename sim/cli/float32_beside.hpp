// Float32Beside: the reference network on the very frames that the flight program gets in fixed point.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "sim/evaluation/host_estimator.hpp"
#include "sim/evaluation/metrics.hpp"
#include "sim/sil/sil_run.hpp"

namespace tumblesight::sim {

struct NumericsComparison {
  ErrorSummary float32;     // error of the last frames
  ErrorSummary difference;  // between float32's attitudes and the flight program's, every frame
  double largest_difference_deg = 0.0;
};

class Float32Beside {
 public:
  // Of the fixed-point image <name>.tsm the reference is <name>.float32.tsm in the same folder. Nothing is
  // there to compare without such a file, or where what flies is float32 itself.
  Float32Beside(const std::string& model_path, const std::vector<std::uint8_t>& model,
                const std::string& target);

  explicit operator bool() const { return estimator_ != nullptr; }
  void frame_sent(const StepRecord& step, const gnc::RangeImage& frame);
  // Over the frames that the flight program and the reference both answered.
  NumericsComparison compare(const std::vector<FrameResult>& results, std::uint32_t frames) const;

 private:
  std::vector<std::uint8_t> image_;
  std::unique_ptr<HostEstimator> estimator_;
  std::vector<FrameResult> answers_;
};

}  // namespace tumblesight::sim
