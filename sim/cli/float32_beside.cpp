#include "sim/cli/float32_beside.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {

Float32Beside::Float32Beside(const std::string& model_path, const std::vector<std::uint8_t>& model,
                             const std::string& target) {
  if (gnc::is_float32(model.data(), model.size())) return;
  std::ifstream file(std::filesystem::path(model_path).replace_extension(".float32.tsm"), std::ios::binary);
  image_.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  if (!gnc::is_float32(image_.data(), image_.size())) return;
  estimator_ = std::make_unique<HostEstimator>(image_, target.c_str());
  if (estimator_->status() != gnc::ModelStatus::kOk) estimator_.reset();
}

void Float32Beside::frame_sent(const StepRecord& step, const gnc::RangeImage& frame) {
  if (!estimator_) return;
  if (step.frame_index == 0) estimator_->reset();
  gnc::AttitudeEstimate estimate;
  FrameResult answer;
  answer.sequence = step.sequence;
  answer.frame = step.frame_index;
  answer.truth = step.truth.q_lrf_trf;
  answer.valid = estimator_->step(frame, estimate) == gnc::FrameStatus::kOk;
  answer.rcnn = gnc::to_double(estimate.q_lrf_trf);
  answers_.push_back(answer);
}

NumericsComparison Float32Beside::compare(const std::vector<FrameResult>& results,
                                          std::uint32_t frames) const {
  NumericsComparison comparison;
  comparison.float32 = summarise(last_frame_errors_deg(answers_, frames, Estimator::kRcnn));
  std::vector<double> differences;
  auto answer = answers_.begin();  // both in the order of the steps; the flight program may have missed some
  for (const FrameResult& result : results) {
    const auto same = [&](const FrameResult& a) {
      return a.sequence == result.sequence && a.frame == result.frame;
    };
    answer = std::find_if(answer, answers_.end(), same);
    if (answer == answers_.end()) break;
    if (result.valid && answer->valid) {
      differences.push_back(kDegPerRad * angular_error_rad(result.rcnn, answer->rcnn));
    }
  }
  if (!differences.empty()) {
    comparison.largest_difference_deg = *std::max_element(differences.begin(), differences.end());
  }
  comparison.difference = summarise(differences);
  return comparison;
}

}  // namespace tumblesight::sim
