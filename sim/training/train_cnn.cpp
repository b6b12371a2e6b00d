#include <algorithm>
#include <memory>
#include <vector>

#include "sim/model/model_file.hpp"
#include "sim/training/import_model.hpp"
#include "sim/training/loss.hpp"
#include "sim/training/parts.hpp"
#include "sim/training/stage.hpp"
#include "sim/training/train.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kGradientNorm = 1.0;  // the paper's gradient threshold
constexpr double kWeightDecay = 1e-4;
constexpr int kValidationFrames = 1024;
constexpr int kCalibrationFrames = 512;
constexpr std::int64_t kIterationsPerPoint = 500;
constexpr std::uint64_t kValidationSeed = 0x76616C6964ULL;

// Weight of the mean over all hypotheses in the loss: 2 %; from random weights 30 % at first, falling to 2 %
// in the first quarter.
double spread_at(const TrainingSettings& settings, double fraction) {
  if (!settings.start_from.empty()) return 0.02;
  const double done = fraction / 0.25;
  return done >= 1.0 ? 0.02 : 0.3 + (0.02 - 0.3) * done;
}

int validation_frames(const TrainingSettings& settings) {
  return static_cast<int>(std::min<std::int64_t>(kValidationFrames, settings.cnn_images));
}

// `data`: the rank's share of the validation frames.
void validate(Cnn& cnn, const FrameBatch& data, const TrainingSettings& settings, TrainingPoint& point) {
  torch::NoGradGuard guard;
  cnn->eval();
  std::vector<torch::Tensor> best, chosen;
  for (std::int64_t i = 0; i < data.images.size(0); i += settings.cnn_batch) {
    const std::int64_t n = std::min<std::int64_t>(settings.cnn_batch, data.images.size(0) - i);
    const auto result = cnn->forward(data.images.narrow(0, i, n).to(settings.device), settings.bfloat16);
    const auto errors = hypothesis_errors(result.output, data.r_view_trf.narrow(0, i, n).to(settings.device));
    best.push_back(errors.best_rad.cpu());
    chosen.push_back(errors.chosen_rad.cpu());
  }
  fill_errors(point, *settings.ranks, validation_frames(settings), best, chosen);
  cnn->train();
}

// Computes the gradient of a batch in the module's parameters. Returns the loss.
double backward(Cnn& cnn, const FrameBatch& batch, const TrainingSettings& settings, double spread) {
  const auto result = cnn->forward(batch.images.to(settings.device), settings.bfloat16);
  const auto errors = hypothesis_errors(result.output, batch.r_view_trf.to(settings.device));
  const torch::Tensor loss = hypothesis_loss(result.output, errors, spread);
  cnn->zero_grad();
  loss.backward();
  return loss.item<double>();
}

FrameBatch rows_of(const FrameBatch& batch, Share rows) {
  return {batch.images.narrow(0, rows.first, rows.count), batch.r_view_trf.narrow(0, rows.first, rows.count)};
}

// `batch`: the rank's rows of it.
double train_once(Cnn& cnn, Parts<Cnn>& parts, const FrameBatch& batch, const TrainingSettings& settings,
                  double spread, torch::optim::Optimizer& optimizer) {
  const double loss = parts.mean_gradient(batch.images.size(0), [&](Cnn& module, Share rows) {
    return backward(module, rows_of(batch, rows), settings, spread);
  });
  torch::nn::utils::clip_grad_norm_(cnn->parameters(), kGradientNorm);
  optimizer.step();
  return loss;
}

// Loads the starting weights and returns their CRC-32; 0 for random weights.
std::uint64_t load_start(const TrainingTargets& targets, const TrainingSettings& settings, Cnn& cnn) {
  if (settings.start_from.empty()) return 0;
  const std::unique_ptr<Float32Model> model = read_float32_model(settings.start_from);
  import_cnn(model->weights, render_frames(targets, settings.seed, 0, kCalibrationFrames).images, cnn);
  return model->header.crc32;
}

StageSettings stage_settings(const TrainingTargets& targets, const TrainingSettings& settings,
                             std::uint64_t start_crc32) {
  StageSettings stage;
  stage.name = "cnn";
  stage.folder = settings.folder;
  stage.iterations = settings.cnn_images / settings.cnn_batch;
  stage.seconds = settings.cnn_seconds;
  stage.batch = settings.cnn_batch;
  stage.unit = "images";
  stage.units_per_batch = settings.cnn_batch;
  stage.learning_rate = settings.cnn_learning_rate;
  stage.iterations_per_point = kIterationsPerPoint;
  stage.checkpoint_s = settings.checkpoint_s;
  stage.fingerprint = fingerprint(
      {settings.seed, settings.cnn_seconds > 0.0 ? kTimed : static_cast<std::uint64_t>(settings.cnn_images),
       static_cast<std::uint64_t>(settings.cnn_batch), targets.meshes_crc32, view_hash(targets), start_crc32,
       bits_of(settings.cnn_learning_rate), static_cast<std::uint64_t>(settings.bfloat16)});
  stage.trainers = settings.trainers;
  stage.ranks = settings.ranks;
  return stage;
}

}  // namespace

void fill_errors(TrainingPoint& point, Ranks& ranks, std::int64_t count,
                 const std::vector<torch::Tensor>& best_rad, const std::vector<torch::Tensor>& chosen_rad) {
  const Share own = ranks.share(count);
  const torch::Tensor all = torch::zeros({2, count});
  if (own.count > 0) {
    all[0].narrow(0, own.first, own.count).copy_(torch::cat(best_rad));
    all[1].narrow(0, own.first, own.count).copy_(torch::cat(chosen_rad));
  }
  ranks.sum({all});
  fill_errors(point, all[0], all[1]);
}

void fill_errors(TrainingPoint& point, const torch::Tensor& best_rad, const torch::Tensor& chosen_rad) {
  point.best_deg = best_rad.mean().item<double>() * kDegPerRad;
  point.mean_deg = chosen_rad.mean().item<double>() * kDegPerRad;
  point.median_deg = chosen_rad.median().item<double>() * kDegPerRad;
  point.within_20deg = (chosen_rad * kDegPerRad <= 20.0).to(torch::kFloat).mean().item<double>();
}

bool train_cnn(const TrainingTargets& targets, const TrainingSettings& settings, Cnn& cnn,
               const std::atomic<bool>& stop) {
  const StageSettings shape = stage_settings(targets, settings, load_start(targets, settings, cnn));
  Stage stage(shape);
  cnn->to(settings.device);
  torch::optim::AdamW optimizer(
      cnn->parameters(), torch::optim::AdamWOptions(settings.cnn_learning_rate).weight_decay(kWeightDecay));
  stage.resume(cnn, optimizer);
  if (stage.finished()) return true;

  Ranks& ranks = *settings.ranks;
  const int frames = validation_frames(settings);
  const FrameBatch validation = render_frames(targets, kValidationSeed, 0, frames, ranks.share(frames));
  FrameStream stream(targets, settings.seed, settings.cnn_batch,
                     static_cast<std::uint64_t>(stage.iteration()), settings.workers,
                     ranks.share(settings.cnn_batch));
  stage.start();
  cnn->train();
  Parts<Cnn> parts(cnn, settings.trainers, ranks, [] { return Cnn(); });
  while (!stage.finished() && !stage.stops(stop)) {
    stage.set_rate(optimizer);
    const double spread = spread_at(settings, stage.fraction());
    stage.advance(train_once(cnn, parts, stream.next(), settings, spread, optimizer));
    if (stage.point_due()) {
      stage.equalize(cnn);
      TrainingPoint point = stage.new_point();
      validate(cnn, validation, settings, point);
      const bool best = stage.add_point(point);
      if (settings.after_point) settings.after_point(point, best);
    }
    stage.save_if_due(cnn, optimizer);
  }
  stage.equalize(cnn);
  stage.save(cnn, optimizer);
  stage.finish_progress();
  return stage.finished();
}

}  // namespace tumblesight::sim
