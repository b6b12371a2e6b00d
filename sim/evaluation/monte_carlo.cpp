#include "sim/evaluation/monte_carlo.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "sim/evaluation/host_estimator.hpp"
#include "sim/world/chaser_navigation.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::chrono::milliseconds kProgressPeriod{50};

// What one peer made of the last frame of a sequence.
struct PeerMatch {
  double error_deg = 180.0;
  bool found = false;
  double ms = 0.0;
};

struct Job {
  const FrameRenderer& renderer;
  const std::vector<std::uint8_t>& model;
  const TemplateMatcher* matcher;
  const MonteCarloSettings& settings;
  std::uint32_t frames;
  std::atomic<std::uint32_t> next{0};
  std::atomic<std::uint32_t> done{0};
  std::vector<FrameResult> results;
  std::vector<std::uint8_t> delivered;                              // per frame: 0 if it was lost
  std::vector<double> network_ms;                                   // per frame
  std::vector<double> baseline_ms;                                  // per sequence
  std::vector<std::vector<std::optional<PeerMatch>>> peer_matches;  // per peer and sequence; none: lost frame
  std::mutex peers_in_turn;
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

void run_baseline(Job& job, const gnc::RangeImage& frame, FrameResult& result) {
  const Stopwatch stopwatch;
  const TemplateMatcher::Result match = job.matcher->match(frame);
  job.baseline_ms[result.sequence] = stopwatch.ms();
  result.has_baseline = true;
  result.baseline_valid = match.valid;
  result.baseline = match.q_lrf_trf;
}

void run_peers(Job& job, const gnc::RangeImage& frame, const FrameResult& result) {
  const std::lock_guard<std::mutex> in_turn(job.peers_in_turn);
  for (std::size_t i = 0; i < job.peer_matches.size(); ++i) {
    const Stopwatch stopwatch;
    const PosePeer::Result match = job.settings.peers[i]->match(frame);
    PeerMatch& made = job.peer_matches[i][result.sequence].emplace();
    made.ms = stopwatch.ms();
    made.found = match.valid;
    const Eigen::Quaterniond found = nearest_equivalent(match.q_lrf_trf, result.truth, job.settings.symmetry);
    if (match.valid) made.error_deg = kDegPerRad * angular_error_rad(result.truth, found);
  }
}

PeerRun peer_run(const std::vector<std::optional<PeerMatch>>& matches) {
  PeerRun run;
  std::vector<double> times_ms;
  for (const std::optional<PeerMatch>& match : matches) {
    if (!match) continue;
    run.errors_deg.push_back(match->error_deg);
    run.found += match->found ? 1 : 0;
    times_ms.push_back(match->ms);
  }
  run.ms = median(std::move(times_ms));
  return run;
}

void run_sequence(Job& job, std::uint32_t index, HostEstimator& estimator, gnc::RangeImage& frame) {
  const Sequence sequence = make_sequence(job.settings.scenario, job.settings.seed, index);
  estimator.reset();
  for (std::uint32_t k = 0; k < job.frames; ++k) {
    const FrameTruth& truth = sequence.frames[k];
    if (truth.lost) continue;
    job.renderer.render(sequence, k, frame);
    const gnc::ChaserAttitude chaser =
        chaser_attitude(truth, frame.exposure_time_ns, !job.settings.scenario.disturbances.no_ego_motion);
    const std::size_t place = std::size_t{index} * job.frames + k;
    const Stopwatch stopwatch;
    const gnc::FrameOutcome outcome = estimator.step(frame, chaser);
    job.network_ms[place] = stopwatch.ms();
    FrameResult& result = job.results[place];
    result = frame_result(truth, outcome, job.renderer.swath_m(), job.settings.symmetry);
    result.sequence = index;
    result.frame = k;
    job.delivered[place] = 1;
  }
  const std::size_t last = (std::size_t{index} + 1) * job.frames - 1;
  if (index < job.baseline_ms.size()) run_baseline(job, frame, job.results[last]);
  if (index < job.settings.baseline_sequences && job.delivered[last] != 0)
    run_peers(job, frame, job.results[last]);
}

void remove_lost(Job& job) {
  std::size_t kept = 0;
  for (std::size_t place = 0; place < job.results.size(); ++place) {
    if (job.delivered[place] == 0) continue;
    job.results[kept] = job.results[place];
    job.network_ms[kept] = job.network_ms[place];
    ++kept;
  }
  job.results.resize(kept);
  job.network_ms.resize(kept);
}

void work(Job& job) {
  HostEstimator estimator(job.model);
  const auto frame = std::make_unique<gnc::RangeImage>();
  if (estimator.status() != gnc::ModelStatus::kOk) {
    throw std::invalid_argument("the estimator refuses the model image");
  }
  for (std::uint32_t index = job.next++; index < job.settings.sequences; index = job.next++) {
    run_sequence(job, index, estimator, *frame);
    ++job.done;
  }
}

}  // namespace

MonteCarloResult run_monte_carlo(const FrameRenderer& renderer, const std::vector<std::uint8_t>& model,
                                 const TemplateMatcher* matcher, const MonteCarloSettings& settings,
                                 const std::function<void(std::uint32_t)>& progress) {
  if (settings.scenario.frames < 1) throw std::invalid_argument("a sequence needs at least one frame");
  const auto frames = static_cast<std::uint32_t>(settings.scenario.frames);
  Job job{renderer, model, matcher, settings, frames, {}, {}, {}, {}, {}, {}, {}, {}};
  job.results.resize(std::size_t{settings.sequences} * frames);
  job.delivered.resize(job.results.size());
  job.network_ms.resize(job.results.size());
  const std::uint32_t matched = std::min(settings.baseline_sequences, settings.sequences);
  if (matcher != nullptr) job.baseline_ms.resize(matched);
  job.peer_matches.resize(settings.peers.size());
  for (auto& matches : job.peer_matches) matches.resize(matched);
  std::vector<std::future<void>> workers;
  for (int i = 0; i < std::max(1, settings.threads); ++i) {
    workers.push_back(std::async(std::launch::async, [&job] { work(job); }));
  }
  for (std::future<void>& worker : workers) {
    while (worker.wait_for(kProgressPeriod) != std::future_status::ready) progress(job.done);
    worker.get();
  }
  progress(job.done);
  remove_lost(job);
  for (FrameResult& result : job.results) take_nearest_equivalents(result, settings.symmetry);
  std::vector<PeerRun> peers;
  for (const auto& matches : job.peer_matches) peers.push_back(peer_run(matches));
  return {std::move(job.results), median(std::move(job.network_ms)), median(std::move(job.baseline_ms)),
          std::move(peers)};
}

}  // namespace tumblesight::sim
