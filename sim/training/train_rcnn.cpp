#include <chrono>
#include <memory>

#include "sim/training/checkpoint.hpp"
#include "sim/training/export_model.hpp"
#include "sim/training/loss.hpp"
#include "sim/training/sequence_features.hpp"
#include "sim/training/train.hpp"

namespace tumblesight::sim {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kGradientNorm = 1.0;
constexpr std::int64_t kValidationSequences = 512;
constexpr std::uint64_t kValidationSeed = 0x76616C6964ULL + 1;
constexpr std::int64_t kFirstSequences = 2048;      // there before the first iteration
constexpr std::int64_t kSequencesPerIteration = 8;  // by how much the supply grows while it is learnt from
constexpr std::int64_t kIterationsPerPoint = 100;
constexpr double kSpread = 0.02;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Which sequences the iteration learns from depends on its number only, so a resumed run goes on as if
// uninterrupted.
torch::Tensor draw(std::uint64_t seed, std::int64_t iteration, std::int64_t available, int batch) {
  auto generator =
      at::make_generator<at::CPUGeneratorImpl>(seed * 1'000'003ULL + static_cast<std::uint64_t>(iteration));
  return torch::randint(available, {batch}, generator, torch::kLong);
}

void standardise(Recurrent& recurrent, const FeatureSet& data) {
  const torch::Tensor x = lstm_input(data.dense2, data.output).flatten(0, 1);
  recurrent->set_standardisation(x.mean(0), x.std(0));
}

void validate(Recurrent& recurrent, const FeatureSet& data, const torch::Device& device,
              TrainingPoint& point) {
  torch::NoGradGuard guard;
  const torch::Tensor output = recurrent->forward(data.dense2.to(device), data.output.to(device));
  const auto errors = hypothesis_errors(output.select(1, -1), data.r_lrf_trf.select(1, -1).to(device));
  fill_errors(point, errors.best_rad.cpu(), errors.chosen_rad.cpu());
}

double train_once(Recurrent& recurrent, const FeatureSet& data, const torch::Tensor& rows,
                  const torch::Device& device, torch::optim::Optimizer& optimizer) {
  const auto pick = [&](const torch::Tensor& t) { return t.index_select(0, rows).to(device); };
  const torch::Tensor output = recurrent->forward(pick(data.dense2), pick(data.output));
  const torch::Tensor loss =
      hypothesis_loss(output, hypothesis_errors(output, pick(data.r_lrf_trf)), kSpread);
  optimizer.zero_grad();
  loss.backward();
  torch::nn::utils::clip_grad_norm_(recurrent->parameters(), kGradientNorm);
  optimizer.step();
  return loss.item<double>();
}

}  // namespace

bool train_rcnn(const TrainingTargets& targets, const TrainingSettings& settings, const Cnn& cnn,
                Recurrent& recurrent, const std::atomic<bool>& stop) {
  const std::string path = settings.folder + "/rcnn.ckpt";
  const std::int64_t total = settings.rcnn_iterations;
  recurrent->to(settings.device);
  torch::optim::AdamW optimizer(recurrent->parameters(),
                                torch::optim::AdamWOptions(settings.rcnn_learning_rate).weight_decay(1e-3));
  CheckpointPosition position;
  const bool resumed = load_checkpoint(path, recurrent, &optimizer, position);
  if (position.iteration >= total) return true;

  const auto weights = std::make_unique<gnc::NetworkWeights>();
  export_weights(cnn, recurrent, *weights);
  const FeatureSet validation =
      SequenceFeatures(targets, *weights, kValidationSeed, kValidationSequences, settings.workers + 1)
          .first(kValidationSequences);
  SequenceFeatures supply(targets, *weights, settings.seed, settings.rcnn_sequences, settings.workers);
  if (!resumed) standardise(recurrent, supply.first(std::min(kFirstSequences, settings.rcnn_sequences)));

  TrainingLog log(settings.folder, "rcnn", position.iteration);
  ProgressLine progress;
  const double seconds_before = position.seconds;
  const std::int64_t first = position.iteration;
  const auto start = Clock::now();
  auto last_checkpoint = start;
  double loss_sum = 0.0, last_loss = 0.0;
  TrainingPoint point;
  while (position.iteration < total && !stop) {
    const double rate = cosine_rate(settings.rcnn_learning_rate, position.iteration, total);
    for (auto& group : optimizer.param_groups()) group.options().set_lr(rate);
    const std::int64_t available =
        std::min(settings.rcnn_sequences, kFirstSequences + kSequencesPerIteration * position.iteration);
    const FeatureSet data = supply.first(available);
    const torch::Tensor rows = draw(settings.seed, position.iteration, available, settings.rcnn_batch);
    loss_sum += train_once(recurrent, data, rows, settings.device, optimizer);

    ++position.iteration;
    position.seconds = seconds_before + seconds_since(start);
    if (position.iteration % kIterationsPerPoint == 0 || position.iteration == total) {
      last_loss = loss_sum / static_cast<double>((position.iteration - 1) % kIterationsPerPoint + 1);
      loss_sum = 0.0;
      point = {"rcnn",
               position.iteration,
               position.iteration * settings.rcnn_batch,
               position.seconds,
               rate,
               last_loss,
               0,
               0,
               0,
               0};
      validate(recurrent, validation, settings.device, point);
      log.add(point);
    }
    progress.show(
        "rcnn", position.iteration * settings.rcnn_batch, total * settings.rcnn_batch,
        static_cast<double>((position.iteration - first) * settings.rcnn_batch) / seconds_since(start),
        "sequences", last_loss, point.mean_deg);
    if (seconds_since(last_checkpoint) > settings.checkpoint_s) {
      save_checkpoint(path, recurrent, optimizer, position);
      last_checkpoint = Clock::now();
    }
  }
  save_checkpoint(path, recurrent, optimizer, position);
  progress.finish();
  return position.iteration >= total;
}

}  // namespace tumblesight::sim
