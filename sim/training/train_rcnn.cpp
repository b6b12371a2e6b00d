#include <ATen/CPUGeneratorImpl.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

#include "gnc/numerics/crc.hpp"
#include "sim/training/export_model.hpp"
#include "sim/training/loss.hpp"
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
void validate(Recurrent& recurrent, const FeatureSet& data, const torch::Device& device,
              TrainingPoint& point) {
  torch::NoGradGuard guard;
  const FeatureSet all = rows_of(data, torch::arange(data.r_lrf_trf.size(0)), device);
  const TrackedSequences tracked = recurrent->forward(all.hypotheses);
  const torch::Tensor truth = all.r_lrf_trf.select(1, kFramesPerSequence - 1);
  const auto last = [](const torch::Tensor& t) { return t.select(1, kFramesPerSequence - 1); };
  const torch::Tensor clusters = angle_between(last(tracked.cluster_means), truth.unsqueeze(1));
  fill_errors(point, std::get<0>(clusters.min(-1)).cpu(),
              angle_between(last(tracked.r_lrf_trf), truth).cpu());
}

double train_once(Recurrent& recurrent, const FeatureSet& data, const torch::Tensor& rows,
                  const torch::Device& device, torch::optim::Optimizer& optimizer) {
  const FeatureSet batch = rows_of(data, rows, device);
  const torch::Tensor loss = tracking_loss(recurrent->forward(batch.hypotheses), batch.r_lrf_trf);
  optimizer.zero_grad();
  loss.backward();
  torch::nn::utils::clip_grad_norm_(recurrent->parameters(), kGradientNorm);
  optimizer.step();
  return loss.item<double>();
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
  return stage;
}

std::int64_t first_sequences(const TrainingSettings& settings) {
  if (settings.rcnn_seconds == 0.0) return std::min(kFirstSequences, settings.rcnn_sequences);
  const auto affordable = static_cast<std::int64_t>(kFirstSequencesPerSecond * settings.rcnn_seconds);
  return std::min(settings.rcnn_sequences, std::clamp(affordable, kFewestFirstSequences, kFirstSequences));
}

// Returns false if `stop` became true before `count` sequences were ready.
bool wait_for(SequenceFeatures& supply, std::int64_t count, const char* what, const std::atomic<bool>& stop) {
  if (supply.ready() >= count) return !stop;
  ProgressBar progress("rcnn", what, static_cast<std::uint64_t>(count));
  for (std::int64_t ready = supply.ready(); ready < count && !stop; ready = supply.ready()) {
    progress.update(static_cast<std::uint64_t>(ready));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return !stop;
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

  const std::int64_t at_first = first_sequences(settings);
  const auto available_at = [&](std::int64_t iteration) {
    return std::min(settings.rcnn_sequences, at_first + kSequencesPerIteration * iteration);
  };
  // A run that goes on needs what it had; that is not time of the stage.
  if (settings.rcnn_seconds > 0.0 && !resumed) stage.start_clock();
  const std::int64_t test_count = std::min({kValidationSequences, settings.rcnn_sequences, at_first});
  SequenceFeatures tests(targets, *weights, kValidationSeed, test_count, settings.workers + 1);
  if (!wait_for(tests, test_count, "validation sequences", stop)) return false;
  const FeatureSet validation = tests.first(test_count);
  SequenceFeatures supply(targets, *weights, settings.seed, settings.rcnn_sequences, settings.workers);
  if (!wait_for(supply, available_at(stage.iteration()), "first sequences", stop)) return false;
  if (!resumed) standardise(recurrent, supply.first(at_first), settings.device);

  stage.start();
  while (!stage.finished() && !stop) {
    stage.set_rate(optimizer);
    const std::int64_t available = available_at(stage.iteration());
    const torch::Tensor rows = draw(settings.seed, stage.iteration(), available, settings.rcnn_batch);
    stage.advance(train_once(recurrent, supply.first(available), rows, settings.device, optimizer));
    if (stage.point_due()) {
      TrainingPoint point = stage.new_point();
      validate(recurrent, validation, settings.device, point);
      const bool best = stage.add_point(point);
      if (settings.after_point) settings.after_point(point, best);
    }
    stage.save_if_due(recurrent, optimizer);
  }
  stage.save(recurrent, optimizer);
  stage.finish_progress();
  return stage.finished();
}

}  // namespace tumblesight::sim
