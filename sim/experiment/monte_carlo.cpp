#include "sim/experiment/monte_carlo.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <numeric>
#include <stdexcept>

#include "sim/evaluation/host_estimator.hpp"
#include "sim/world/chaser_navigation.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::chrono::milliseconds kProgressPeriod{50};

struct Job {
  const FrameRenderer& renderer;
  const std::vector<std::uint8_t>& model;
  const TemplateMatcher* matcher;
  const MonteCarloSettings& settings;
  const std::vector<std::uint32_t>& indices;
  const SequenceSink& take;
  std::atomic<std::size_t> next{0};
  std::atomic<std::uint32_t> done{0};
  std::mutex take_in_turn{};
};

class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

FrameResult frame_result(const FrameTruth& truth, const gnc::FrameOutcome& outcome, double swath_m,
                         const TargetSymmetry& symmetry) {
  FrameResult result;
  result.truth = truth.q_lrf_trf;
  result.range_m = truth.range_m;
  result.rate_rad_s = truth.rate_lrf_rad_s.norm();
  result.valid = outcome.used();
  result.owed = truth.is_genuine();
  result.trusted = outcome.valid();
  if (!result.valid) return result;
  const gnc::AttitudeEstimate& estimate = outcome.estimate;
  result.rcnn = gnc::to_double(estimate.q_lrf_trf);
  result.cnn = gnc::to_double(estimate.q_lrf_trf_single_frame);
  result.rcnn_predicted_rad = 1e-6 * estimate.predicted_error_urad;
  result.cnn_predicted_rad = 1e-6 * estimate.predicted_error_single_frame_urad;
  result.pose = pose_errors(stated_pose(estimate.pose), truth, swath_m, symmetry);
  return result;
}

void run_baseline(const Job& job, const gnc::RangeImage& frame, SequenceResult& made) {
  const Stopwatch stopwatch;
  const TemplateMatcher::Result match = job.matcher->match(frame);
  made.baseline_ms = stopwatch.ms();
  FrameResult& last = made.frames.back();
  last.has_baseline = true;
  last.baseline_valid = match.valid;
  last.baseline = match.q_lrf_trf;
}

SequenceResult run_sequence(Job& job, std::uint32_t index, HostEstimator& estimator, gnc::RangeImage& frame) {
  const Sequence sequence = make_sequence(job.settings.scenario, job.settings.seed, index);
  const auto frames = static_cast<std::uint32_t>(sequence.frames.size());
  SequenceResult made;
  made.sequence = index;
  made.frames.reserve(frames);
  double step_ms = 0.0;
  estimator.reset();
  for (std::uint32_t k = 0; k < frames; ++k) {
    const FrameTruth& truth = sequence.frames[k];
    if (truth.lost) continue;
    job.renderer.render(sequence, k, frame);
    const gnc::ChaserAttitude chaser =
        chaser_attitude(truth, frame.exposure_time_ns, !job.settings.scenario.disturbances.no_ego_motion);
    const Stopwatch stopwatch;
    const gnc::FrameOutcome outcome = estimator.step(frame, chaser);
    step_ms += stopwatch.ms();
    FrameResult& result =
        made.frames.emplace_back(frame_result(truth, outcome, job.renderer.swath_m(), job.settings.symmetry));
    result.sequence = index;
    result.frame = k;
  }
  if (made.frames.empty()) return made;
  made.step_ms = step_ms / static_cast<double>(made.frames.size());
  const bool matched = index < job.settings.baseline_sequences && !sequence.frames.back().lost;
  if (matched && job.matcher != nullptr) run_baseline(job, frame, made);
  return made;
}

void work(Job& job) {
  HostEstimator estimator(job.model);
  const auto frame = std::make_unique<gnc::RangeImage>();
  if (estimator.status() != gnc::ModelStatus::kOk) {
    throw std::invalid_argument("the estimator refuses the model image");
  }
  for (std::size_t place = job.next++; place < job.indices.size(); place = job.next++) {
    SequenceResult made = run_sequence(job, job.indices[place], estimator, *frame);
    const std::lock_guard<std::mutex> in_turn(job.take_in_turn);
    job.take(std::move(made));
    ++job.done;
  }
}

// A failure of one worker leaves nothing to do for the others.
void work_or_stop(Job& job) {
  try {
    work(job);
  } catch (...) {
    job.next = job.indices.size();
    throw;
  }
}

}  // namespace

void run_sequences(const FrameRenderer& renderer, const std::vector<std::uint8_t>& model,
                   const TemplateMatcher* matcher, const MonteCarloSettings& settings,
                   const std::vector<std::uint32_t>& indices, const SequenceSink& take,
                   const std::function<void(std::uint32_t)>& progress) {
  if (settings.scenario.frames < 1) throw std::invalid_argument("a sequence needs at least one frame");
  Job job{renderer, model, matcher, settings, indices, take};
  std::vector<std::future<void>> workers;
  for (int i = 0; i < std::max(1, settings.threads); ++i) {
    workers.push_back(std::async(std::launch::async, [&job] { work_or_stop(job); }));
  }
  for (std::future<void>& worker : workers) {
    while (worker.wait_for(kProgressPeriod) != std::future_status::ready) progress(job.done);
    worker.get();
  }
  progress(job.done);
}

MonteCarloResult joined(std::vector<SequenceResult> results, const TargetSymmetry& symmetry) {
  std::sort(results.begin(), results.end(),
            [](const SequenceResult& a, const SequenceResult& b) { return a.sequence < b.sequence; });
  MonteCarloResult all;
  std::vector<double> step_ms;
  std::vector<double> baseline_ms;
  std::size_t frames = 0;
  for (const SequenceResult& result : results) frames += result.frames.size();
  all.frames.reserve(frames);
  for (SequenceResult& result : results) {
    if (!result.frames.empty()) step_ms.push_back(result.step_ms);
    if (result.baseline_ms > 0.0) baseline_ms.push_back(result.baseline_ms);
    for (FrameResult& frame : result.frames) {
      take_nearest_equivalents(frame, symmetry);
      all.frames.push_back(frame);
    }
    std::vector<FrameResult>().swap(result.frames);  // a million sequences are a few gigabytes
  }
  all.step_ms = median(std::move(step_ms));
  all.baseline_ms = median(std::move(baseline_ms));
  return all;
}

MonteCarloResult run_monte_carlo(const FrameRenderer& renderer, const std::vector<std::uint8_t>& model,
                                 const TemplateMatcher* matcher, const MonteCarloSettings& settings,
                                 const std::function<void(std::uint32_t)>& progress) {
  std::vector<std::uint32_t> indices(settings.sequences);
  std::iota(indices.begin(), indices.end(), 0U);
  std::vector<SequenceResult> results;
  results.reserve(indices.size());
  run_sequences(
      renderer, model, matcher, settings, indices,
      [&](SequenceResult&& result) { results.push_back(std::move(result)); }, progress);
  return joined(std::move(results), settings.symmetry);
}

}  // namespace tumblesight::sim
