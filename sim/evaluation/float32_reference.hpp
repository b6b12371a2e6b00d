// Float32Reference: the network in float32, run on the same frames as the fixed-point model under test, to
// compare the two.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim/evaluation/host_estimator.hpp"
#include "sim/evaluation/metrics.hpp"
#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::sim {

struct NumericsComparison {
  ErrorSummary float32;     // error of the last frames
  ErrorSummary difference;  // angle between float32's attitudes and those under test, every frame
  double largest_difference_deg = 0.0;
};

class Float32Reference {
 public:
  // The reference for the fixed-point image <name>.tsm is <name>.float32.tsm in the same folder. There is
  // none without that file, or when `model`, the image under test, is in float32 itself.
  Float32Reference(const std::string& model_path, const std::vector<std::uint8_t>& model,
                   const std::string& target);

  // Whether there is a reference. Without one, add() does nothing.
  explicit operator bool() const { return estimator_ != nullptr; }
  // The next frame that was delivered. `chaser`: as the estimator under test was told it.
  void add(std::uint32_t sequence, std::uint32_t frame, const FrameTruth& truth, const gnc::RangeImage& image,
           const gnc::ChaserAttitude& chaser);
  // Over the frames that have a result both here and in `results`, which are in the order of add(). A frame
  // that was not delivered has none here. Attitudes that look the same do not differ.
  NumericsComparison compare(const std::vector<FrameResult>& results, std::uint32_t frames,
                             const TargetSymmetry& symmetry = {}) const;

 private:
  std::vector<std::uint8_t> image_;
  std::unique_ptr<HostEstimator> estimator_;
  std::vector<FrameResult> results_;
};

}  // namespace tumblesight::sim
