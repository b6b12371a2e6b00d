#include <ATen/CPUGeneratorImpl.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "gnc/numerics/crc.hpp"
#include "sim/training/export_model.hpp"
#include "sim/training/loss.hpp"
#include "sim/training/parts.hpp"
#include "sim/training/sequence_features.hpp"
#include "sim/training/stage.hpp"
#include "sim/training/train.hpp"
#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::sim {
namespace {

// Version of the rule for the times between frames (sequence_features.cpp). A checkpoint of another one is
// refused.
constexpr std::uint64_t kTimings = 1;
constexpr double kGradientNorm = 1.0;
constexpr double kWeightDecay = 1e-3;
constexpr std::int64_t kValidationSequences = 512;
constexpr std::uint64_t kValidationSeed = 0x76616C6964ULL + 1;
constexpr std::int64_t kFirstSequences = 2048;    // available before the first iteration
constexpr double kFirstSequencesPerSecond = 4.0;  // of a stage with a time of its own: fewer for a short one
constexpr std::int64_t kFewestFirstSequences = 256;
constexpr std::int64_t kSequencesPerIteration = 8;  // added with every iteration
constexpr std::int64_t kIterationsPerPoint = 100;

// Rows of the iteration's batch. They depend only on seed and iteration, so that a resumed run equals an
// uninterrupted one.
torch::Tensor draw(std::uint64_t seed, std::int64_t iteration, std::int64_t available, int batch) {
  auto generator =
      at::make_generator<at::CPUGeneratorImpl>(seed * 1'000'003ULL + static_cast<std::uint64_t>(iteration));
  return torch::randint(available, {batch}, generator, torch::kLong);
}

void standardise(Recurrent& recurrent, const FeatureSet& data, const torch::Device& device) {
  const FeatureSet some =
      rows_of(data, torch::arange(std::min<std::int64_t>(512, data.r_lrf_trf.size(0))), device);
  torch::NoGradGuard guard;
  const torch::Tensor inputs = recurrent->forward(some.hypotheses).inputs.flatten(0, 1);
  recurrent->set_standardisation(inputs.mean(0), inputs.std(0));
}

// Errors in the last frame of the paper's sequences.
void validate(Recurrent& recurrent, const FeatureSet& data, const TrainingSettings& settings,
              TrainingPoint& point) {
  torch::NoGradGuard guard;
  const std::int64_t count = data.r_lrf_trf.size(0);
  const Share own = settings.ranks->share(count);
  if (own.count == 0) return fill_errors(point, *settings.ranks, count, {}, {});
  const FeatureSet some = rows_of(data, torch::arange(own.first, own.first + own.count), settings.device);
  const TrackedSequences tracked = recurrent->forward(some.hypotheses);
  const torch::Tensor truth = some.r_lrf_trf.select(1, kFramesPerSequence - 1);
  const auto last = [](const torch::Tensor& t) { return t.select(1, kFramesPerSequence - 1); };
  const torch::Tensor clusters = angle_between(last(tracked.cluster_means), truth.unsqueeze(1));
  fill_errors(point, *settings.ranks, count, {std::get<0>(clusters.min(-1)).cpu()},
              {angle_between(last(tracked.r_lrf_trf), truth).cpu()});
}

// Computes the gradient of a batch in the module's parameters. Returns the loss.
double backward(Recurrent& recurrent, const FeatureSet& batch) {
  const torch::Tensor loss = tracking_loss(recurrent->forward(batch.hypotheses), batch.r_lrf_trf);
  recurrent->zero_grad();
  loss.backward();
  return loss.item<double>();
}

// `rows`: the rank's rows of the batch.
double train_once(Recurrent& recurrent, Parts<Recurrent>& parts, const FeatureSet& data,
                  const torch::Tensor& rows, const torch::Device& device,
                  torch::optim::Optimizer& optimizer) {
  const double loss = parts.mean_gradient(rows.size(0), [&](Recurrent& module, Share part) {
    return backward(module, rows_of(data, rows.narrow(0, part.first, part.count), device));
  });
  torch::nn::utils::clip_grad_norm_(recurrent->parameters(), kGradientNorm);
  optimizer.step();
  return loss;
}

// CRC-32 of the frozen CNN's weights. An LSTM only works with the features of its own CNN.
std::uint32_t crc32_of_cnn(const gnc::NetworkWeights<gnc::Float32>& weights) {
  gnc::Crc32 crc;
  gnc::for_each_tensor(weights, [&](const char* layer, const char*, const auto& tensor) {
    if (gnc::layer_index(layer) < gnc::kLstmLayer) crc.add_f32(tensor.data(), tensor.size());
  });
  return crc.value();
}

std::uint32_t crc32_of(const gnc::Inertia<float>& inertia) {
  gnc::Crc32 crc;
  crc.add_f32(inertia.tensor_trf.data(), 9);
  return crc.value();
}

StageSettings stage_settings(const TrainingTargets& targets, const TrainingSettings& settings,
                             const gnc::NetworkWeights<gnc::Float32>& weights) {
  StageSettings stage;
  stage.name = "rcnn";
  stage.folder = settings.folder;
  stage.iterations = settings.rcnn_iterations;
  stage.seconds = settings.rcnn_seconds;
  stage.batch = settings.rcnn_batch;
  stage.unit = "batches";
  stage.learning_rate = settings.rcnn_learning_rate;
  stage.iterations_per_point = kIterationsPerPoint;
  stage.checkpoint_s = settings.checkpoint_s;
  stage.fingerprint = fingerprint(
      {settings.seed, static_cast<std::uint64_t>(settings.rcnn_sequences),
       settings.rcnn_seconds > 0.0 ? kTimed : static_cast<std::uint64_t>(settings.rcnn_iterations),
       static_cast<std::uint64_t>(settings.rcnn_batch), targets.meshes_crc32, view_hash(targets),
       crc32_of_cnn(weights), bits_of(settings.rcnn_learning_rate), crc32_of(targets.inertia), kTimings});
  stage.trainers = settings.trainers;
  stage.ranks = settings.ranks;
  return stage;
}

std::int64_t first_sequences(const TrainingSettings& settings) {
  if (settings.rcnn_seconds == 0.0) return std::min(kFirstSequences, settings.rcnn_sequences);
  const auto affordable = static_cast<std::int64_t>(kFirstSequencesPerSecond * settings.rcnn_seconds);
  return std::min(settings.rcnn_sequences, std::clamp(affordable, kFewestFirstSequences, kFirstSequences));
}

// Returns false if `stop` became true on a rank before all had their part of `count` sequences ready.
bool wait_for(SequenceFeatures& supply, std::int64_t count, const char* what, Ranks& ranks,
              const std::atomic<bool>& stop) {
  constexpr std::int64_t kStop = -1;
  std::unique_ptr<ProgressBar> progress;
  for (;;) {
    const std::vector<std::int64_t> all = ranks.gather(stop ? kStop : supply.ready());
    const std::int64_t ready = *std::min_element(all.begin(), all.end());
    if (ready == kStop || ready >= count) return ready != kStop;
    if (ranks.leads() && !progress)
      progress = std::make_unique<ProgressBar>("rcnn", what, static_cast<std::uint64_t>(count));
    if (progress) progress->update(static_cast<std::uint64_t>(ready));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

}  // namespace

bool train_rcnn(const TrainingTargets& targets, const TrainingSettings& settings, const Cnn& cnn,
                Recurrent& recurrent, const std::atomic<bool>& stop) {
  const auto weights = std::make_unique<gnc::NetworkWeights<gnc::Float32>>();
  export_weights(cnn, recurrent, *weights);
  Stage stage(stage_settings(targets, settings, *weights));
  recurrent->to(settings.device);
  torch::optim::AdamW optimizer(
      recurrent->parameters(),
      torch::optim::AdamWOptions(settings.rcnn_learning_rate).weight_decay(kWeightDecay));
  const bool resumed = stage.resume(recurrent, optimizer);
  if (stage.finished()) return true;

  Ranks& ranks = *settings.ranks;
  const std::int64_t at_first = first_sequences(settings);
  const auto available_at = [&](std::int64_t iteration) {
    return std::min(settings.rcnn_sequences, at_first + kSequencesPerIteration * iteration);
  };
  // A run that goes on needs what it had; that is not time of the stage.
  if (settings.rcnn_seconds > 0.0 && !resumed) stage.start_clock();
  const std::int64_t test_count = std::min({kValidationSequences, settings.rcnn_sequences, at_first});
  SequenceFeatures tests(targets, *weights, kValidationSeed, test_count, settings.workers + 1,
                         settings.ranks);
  if (!wait_for(tests, test_count, "validation sequences", ranks, stop)) return false;
  const FeatureSet validation = tests.first(test_count);
  SequenceFeatures supply(targets, *weights, settings.seed, settings.rcnn_sequences, settings.workers,
                          settings.ranks);
  if (!wait_for(supply, available_at(stage.iteration()), "first sequences", ranks, stop)) return false;
  if (!resumed) standardise(recurrent, supply.first(at_first), settings.device);
  stage.equalize(recurrent);

  stage.start();
  Parts<Recurrent> parts(recurrent, settings.trainers, ranks,
                         [&targets] { return Recurrent(targets.inertia); });
  while (!stage.finished() && !stage.stops(stop)) {
    stage.set_rate(optimizer);
    const std::int64_t available = available_at(stage.iteration());
    const torch::Tensor rows = draw(settings.seed, stage.iteration(), available, settings.rcnn_batch);
    const Share own = ranks.share(rows.size(0));
    stage.advance(train_once(recurrent, parts, supply.first(available), rows.narrow(0, own.first, own.count),
                             settings.device, optimizer));
    if (stage.point_due()) {
      stage.equalize(recurrent);
      TrainingPoint point = stage.new_point();
      validate(recurrent, validation, settings, point);
      const bool best = stage.add_point(point);
      if (settings.after_point) settings.after_point(point, best);
    }
    stage.save_if_due(recurrent, optimizer);
  }
  stage.equalize(recurrent);
  stage.save(recurrent, optimizer);
  stage.finish_progress();
  return stage.finished();
}

}  // namespace tumblesight::sim
