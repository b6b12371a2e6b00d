#include <ATen/Parallel.h>

#include <future>
#include <memory>
#include <vector>

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
double spread_at(const TrainingSettings& settings, double fraction) {
  if (!settings.start_from.empty()) return 0.02;
  const double done = fraction / 0.25;
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

// Computes the gradient of a batch in the module's parameters. Returns the loss.
double backward(Cnn& cnn, const FrameBatch& batch, const TrainingSettings& settings, double spread) {
  const auto result = cnn->forward(batch.images.to(settings.device), settings.bfloat16);
  const auto errors = hypothesis_errors(result.output, batch.r_view_trf.to(settings.device));
  const torch::Tensor loss = hypothesis_loss(result.output, errors, spread);
  cnn->zero_grad();
  loss.backward();
  return loss.item<double>();
}

// Threads that share the batches of one network: its own and replicas, which use its weights.
class Trainers {
 public:
  Trainers(Cnn& cnn, const TrainingSettings& settings) : cnn_(cnn), settings_(settings) {
    for (int i = 1; i < settings.trainers; ++i) {
      Cnn replica;
      replica->to(settings.device);
      replica->train();
      const std::vector<torch::Tensor> own = cnn->parameters();
      std::vector<torch::Tensor> others = replica->parameters();
      for (std::size_t k = 0; k < own.size(); ++k) others[k].set_data(own[k].data());
      replicas_.push_back(replica);
    }
  }

  // The gradient of the whole batch in the network's parameters. Returns the loss.
  double backward_all(const FrameBatch& batch, double spread) {
    if (replicas_.empty()) return backward(cnn_, batch, settings_, spread);
    const std::int64_t part = batch.images.size(0) / settings_.trainers;
    const auto part_of = [&](std::int64_t i) {
      return FrameBatch{batch.images.narrow(0, i * part, part), batch.r_view_trf.narrow(0, i * part, part)};
    };
    std::vector<std::future<double>> others;
    for (std::size_t i = 0; i < replicas_.size(); ++i) {
      others.push_back(std::async(std::launch::async, [&, i] {
        at::set_num_threads(1);  // of this thread
        return backward(replicas_[i], part_of(static_cast<std::int64_t>(i) + 1), settings_, spread);
      }));
    }
    double loss = backward(cnn_, part_of(0), settings_, spread);
    for (std::future<double>& other : others) loss += other.get();
    add_gradients();
    return loss / settings_.trainers;
  }

 private:
  void add_gradients() {
    torch::NoGradGuard guard;
    std::vector<torch::Tensor> own = cnn_->parameters();
    for (Cnn& replica : replicas_) {
      const std::vector<torch::Tensor> others = replica->parameters();
      for (std::size_t k = 0; k < own.size(); ++k) own[k].mutable_grad().add_(others[k].grad());
    }
    for (torch::Tensor& parameter : own) parameter.mutable_grad().div_(settings_.trainers);
  }

  Cnn& cnn_;
  const TrainingSettings& settings_;
  std::vector<Cnn> replicas_;
};

double train_once(Cnn& cnn, Trainers& trainers, const FrameBatch& batch, double spread,
                  torch::optim::Optimizer& optimizer) {
  const double loss = trainers.backward_all(batch, spread);
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
       bits_of(settings.cnn_learning_rate),
       static_cast<std::uint64_t>(settings.bfloat16) +
           2 * static_cast<std::uint64_t>(settings.trainers - 1)});
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
  Trainers trainers(cnn, settings);
  while (!stage.finished() && !stop) {
    stage.set_rate(optimizer);
    const double spread = spread_at(settings, stage.fraction());
    stage.advance(train_once(cnn, trainers, stream.next(), spread, optimizer));
    if (stage.point_due()) {
      TrainingPoint point = stage.new_point();
      validate(cnn, validation, settings, point);
      const bool best = stage.add_point(point);
      if (settings.after_point) settings.after_point(point, best);
    }
    stage.save_if_due(cnn, optimizer);
  }
  stage.save(cnn, optimizer);
  stage.finish_progress();
  return stage.finished();
}

}  // namespace tumblesight::sim
