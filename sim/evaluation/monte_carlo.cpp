#include "sim/evaluation/monte_carlo.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <stdexcept>

#include "gnc/rcnn/attitude_estimator.hpp"
#include "sim/scenario/random.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::chrono::milliseconds kProgressPeriod{50};

struct Job {
  const FlashLidar& lidar;
  double swath_m;
  const std::vector<std::uint8_t>& model;
  const MonteCarloSettings& settings;
  std::atomic<std::uint32_t> next{0};
  std::atomic<std::uint32_t> done{0};
  std::vector<FrameResult> results;
};

FrameResult frame_result(const FrameTruth& truth, const gnc::AttitudeEstimate& estimate, bool valid) {
  FrameResult result;
  result.truth = truth.q_lrf_trf;
  result.valid = valid;
  if (!valid) return result;
  result.rcnn = estimate.q_lrf_trf.cast<double>();
  result.cnn = estimate.q_lrf_trf_single_frame.cast<double>();
  result.rcnn_predicted_rad = static_cast<double>(estimate.predicted_error_rad);
  result.cnn_predicted_rad = static_cast<double>(estimate.predicted_error_single_frame_rad);
  return result;
}

void run_sequence(Job& job, std::uint32_t index, gnc::AttitudeEstimator& estimator, gnc::RangeImage& frame) {
  const MonteCarloSettings& settings = job.settings;
  const Sequence sequence =
      make_sequence(settings.condition, settings.seed, index, static_cast<int>(settings.frames));
  estimator.reset();
  for (std::uint32_t k = 0; k < settings.frames; ++k) {
    const FrameTruth& truth = sequence.frames[k];
    job.lidar.expose(truth, sensor_settings(settings.condition), job.swath_m, mix(sequence.noise_seed, k),
                     frame);
    frame.sequence_number = k;
    frame.exposure_time_ns = kFramePeriod_ns * k;
    gnc::AttitudeEstimate estimate;
    const bool valid = estimator.step(frame, estimate) == gnc::FrameStatus::kOk;
    FrameResult& result = job.results[std::size_t{index} * settings.frames + k];
    result = frame_result(truth, estimate, valid);
    result.sequence = index;
    result.frame = k;
  }
}

void work(Job& job) {
  const auto estimator = std::make_unique<gnc::AttitudeEstimator>();
  const auto frame = std::make_unique<gnc::RangeImage>();
  if (estimator->load(job.model.data(), job.model.size(), nullptr) != gnc::ModelStatus::kOk) {
    throw std::invalid_argument("the estimator refuses the model image");
  }
  for (std::uint32_t index = job.next++; index < job.settings.sequences; index = job.next++) {
    run_sequence(job, index, *estimator, *frame);
    ++job.done;
  }
}

}  // namespace

std::vector<FrameResult> run_monte_carlo(const FlashLidar& lidar, double swath_m,
                                         const std::vector<std::uint8_t>& model,
                                         const MonteCarloSettings& settings,
                                         const std::function<void(std::uint32_t)>& progress) {
  Job job{lidar, swath_m, model, settings, {}, {}, {}};
  job.results.resize(std::size_t{settings.sequences} * settings.frames);
  std::vector<std::future<void>> workers;
  for (int i = 0; i < std::max(1, settings.threads); ++i) {
    workers.push_back(std::async(std::launch::async, [&job] { work(job); }));
  }
  for (std::future<void>& worker : workers) {
    while (worker.wait_for(kProgressPeriod) != std::future_status::ready) progress(job.done);
    worker.get();
  }
  progress(job.done);
  return std::move(job.results);
}

}  // namespace tumblesight::sim
