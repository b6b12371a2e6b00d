#include <memory>

#include "sim/model/model_file.hpp"
#include "sim/training/import_model.hpp"
#include "sim/training/loss.hpp"
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
double spread_at(const TrainingSettings& settings, std::int64_t iteration, std::int64_t total) {
  if (!settings.start_from.empty()) return 0.02;
  const double done = static_cast<double>(iteration) / (0.25 * static_cast<double>(total));
  return done >= 1.0 ? 0.02 : 0.3 + (0.02 - 0.3) * done;
}

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
  fill_errors(point, torch::cat(best), torch::cat(chosen));
  cnn->train();
}

double train_once(Cnn& cnn, const FrameBatch& batch, const TrainingSettings& settings, double spread,
                  torch::optim::Optimizer& optimizer) {
  const auto result = cnn->forward(batch.images.to(settings.device), settings.bfloat16);
  const auto errors = hypothesis_errors(result.output, batch.r_view_trf.to(settings.device));
  const torch::Tensor loss = hypothesis_loss(result.output, errors, spread);
  optimizer.zero_grad();
  loss.backward();
  torch::nn::utils::clip_grad_norm_(cnn->parameters(), kGradientNorm);
  optimizer.step();
  return loss.item<double>();
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
  stage.batch = settings.cnn_batch;
  stage.unit = "images";
  stage.units_per_batch = settings.cnn_batch;
  stage.learning_rate = settings.cnn_learning_rate;
  stage.iterations_per_point = kIterationsPerPoint;
  stage.checkpoint_s = settings.checkpoint_s;
  stage.fingerprint =
      fingerprint({settings.seed, static_cast<std::uint64_t>(settings.cnn_images),
                   static_cast<std::uint64_t>(settings.cnn_batch), targets.meshes_crc32, view_hash(targets),
                   start_crc32, bits_of(settings.cnn_learning_rate), settings.bfloat16});
  return stage;
}

}  // namespace

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

  const FrameBatch validation =
      render_frames(targets, kValidationSeed, 0,
                    static_cast<int>(std::min<std::int64_t>(kValidationFrames, settings.cnn_images)));
  FrameStream stream(targets, settings.seed, settings.cnn_batch,
                     static_cast<std::uint64_t>(stage.iteration()), settings.workers);
  stage.start();
  cnn->train();
  while (!stage.finished() && !stop) {
    stage.set_rate(optimizer);
    const double spread = spread_at(settings, stage.iteration(), shape.iterations);
    stage.advance(train_once(cnn, stream.next(), settings, spread, optimizer));
    if (stage.point_due()) {
      TrainingPoint point = stage.new_point();
      validate(cnn, validation, settings, point);
      stage.add_point(point);
    }
    stage.save_if_due(cnn, optimizer);
  }
  stage.save(cnn, optimizer);
  stage.finish_progress();
  return stage.finished();
}

}  // namespace tumblesight::sim
