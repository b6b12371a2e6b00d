#include "sim/evaluation/float32_reference.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "sim/model/model_file.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {

Float32Reference::Float32Reference(const std::string& model_path, const std::vector<std::uint8_t>& model,
                                   const std::string& target) {
  if (gnc::is_float32(model.data(), model.size())) return;
  const std::string path = model_stem(model_path) + ".float32.tsm";
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return;
  image_ = read_model_bytes(path);
  if (!gnc::is_float32(image_.data(), image_.size())) return;
  estimator_ = std::make_unique<HostEstimator>(image_, target.c_str());
  if (estimator_->status() != gnc::ModelStatus::kOk) estimator_.reset();
}

void Float32Reference::add(std::uint32_t sequence, std::uint32_t frame, const FrameTruth& truth,
                           const gnc::RangeImage& image, const gnc::ChaserAttitude& chaser) {
  if (!estimator_) return;
  if (results_.empty() || results_.back().sequence != sequence) estimator_->reset();
  const gnc::FrameOutcome outcome = estimator_->step(image, chaser);
  FrameResult result;
  result.sequence = sequence;
  result.frame = frame;
  result.truth = truth.q_lrf_trf;
  result.valid = outcome.used();
  result.rcnn = gnc::to_double(outcome.estimate.q_lrf_trf);
  results_.push_back(result);
}

NumericsComparison Float32Reference::compare(const std::vector<FrameResult>& results, std::uint32_t frames,
                                             const TargetSymmetry& symmetry) const {
  NumericsComparison comparison;
  std::vector<FrameResult> nearest = results_;
  for (FrameResult& result : nearest) take_nearest_equivalents(result, symmetry);
  comparison.float32 = summarise(last_frame_errors_deg(nearest, frames, Estimator::kRcnn));
  std::vector<double> differences;
  auto reference = results_.begin();  // both are in the order of the frames; each may lack some
  const auto place = [](const FrameResult& a) { return std::make_pair(a.sequence, a.frame); };
  for (const FrameResult& result : results) {
    while (reference != results_.end() && place(*reference) < place(result)) ++reference;
    if (reference == results_.end()) break;
    if (place(*reference) == place(result) && result.valid && reference->valid) {
      const Eigen::Quaterniond same = nearest_equivalent(result.rcnn, reference->rcnn, symmetry);
      differences.push_back(kDegPerRad * angular_error_rad(same, reference->rcnn));
    }
  }
  if (!differences.empty()) {
    comparison.largest_difference_deg = *std::max_element(differences.begin(), differences.end());
  }
  comparison.difference = summarise(differences);
  return comparison;
}

}  // namespace tumblesight::sim
