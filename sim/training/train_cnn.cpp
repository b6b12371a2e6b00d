#include <chrono>
#include <cmath>

#include "sim/training/checkpoint.hpp"
#include "sim/training/loss.hpp"
#include "sim/training/train.hpp"

namespace tumblesight::sim {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kDegrees = 57.29577951308232;
constexpr double kGradientNorm = 1.0;  // paper: gradient threshold
constexpr std::int64_t kValidationFrames = 1024;
constexpr std::int64_t kIterationsPerPoint = 500;
constexpr std::uint64_t kValidationSeed = 0x76616C6964ULL;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Share of the mean over all hypotheses in the loss: 30 % at the start, 2 % after a quarter.
double spread_at(std::int64_t iteration, std::int64_t total) {
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
    const auto errors = hypothesis_errors(result.output, data.r_lrf_trf.narrow(0, i, n).to(settings.device));
    best.push_back(errors.best_rad.cpu());
    chosen.push_back(errors.chosen_rad.cpu());
  }
  fill_errors(point, torch::cat(best), torch::cat(chosen));
  cnn->train();
}

}  // namespace

double cosine_rate(double peak, std::int64_t iteration, std::int64_t total) {
  constexpr std::int64_t kWarmUp = 200;
  const double fraction = static_cast<double>(iteration) / static_cast<double>(total);
  const double cosine = 0.5 * peak * (1.0 + std::cos(3.14159265358979 * std::min(1.0, fraction)));
  return cosine * std::min(1.0, static_cast<double>(iteration + 1) / kWarmUp);
}

void fill_errors(TrainingPoint& point, const torch::Tensor& best_rad, const torch::Tensor& chosen_rad) {
  point.best_deg = best_rad.mean().item<double>() * kDegrees;
  point.mean_deg = chosen_rad.mean().item<double>() * kDegrees;
  point.median_deg = chosen_rad.median().item<double>() * kDegrees;
  point.within_20deg = (chosen_rad * kDegrees <= 20.0).to(torch::kFloat).mean().item<double>();
}

bool train_cnn(const TrainingTargets& targets, const TrainingSettings& settings, Cnn& cnn,
               const std::atomic<bool>& stop) {
  const std::string path = settings.folder + "/cnn.ckpt";
  const std::int64_t total = settings.cnn_images / settings.cnn_batch;
  cnn->to(settings.device);
  torch::optim::AdamW optimizer(cnn->parameters(),
                                torch::optim::AdamWOptions(settings.cnn_learning_rate).weight_decay(1e-4));
  CheckpointPosition position;
  load_checkpoint(path, cnn, &optimizer, position);
  if (position.iteration >= total) return true;

  TrainingLog log(settings.folder, "cnn", position.iteration);
  ProgressLine progress;
  const FrameBatch validation = render_frames(targets, kValidationSeed, 0, kValidationFrames);
  FrameStream stream(targets, settings.seed, settings.cnn_batch, position.iteration, settings.workers);
  const double seconds_before = position.seconds;
  const std::int64_t first = position.iteration;
  const auto start = Clock::now();
  auto last_checkpoint = start;
  double loss_sum = 0.0, last_loss = 0.0;
  TrainingPoint point;
  cnn->train();
  while (position.iteration < total && !stop) {
    const double rate = cosine_rate(settings.cnn_learning_rate, position.iteration, total);
    for (auto& group : optimizer.param_groups()) group.options().set_lr(rate);
    const FrameBatch batch = stream.next();
    const auto result = cnn->forward(batch.images.to(settings.device), settings.bfloat16);
    const auto errors = hypothesis_errors(result.output, batch.r_lrf_trf.to(settings.device));
    const torch::Tensor loss = hypothesis_loss(result.output, errors, spread_at(position.iteration, total));
    optimizer.zero_grad();
    loss.backward();
    torch::nn::utils::clip_grad_norm_(cnn->parameters(), kGradientNorm);
    optimizer.step();
    loss_sum += loss.item<double>();

    ++position.iteration;
    position.seconds = seconds_before + seconds_since(start);
    if (position.iteration % kIterationsPerPoint == 0 || position.iteration == total) {
      const std::int64_t since = (position.iteration - 1) % kIterationsPerPoint + 1;
      last_loss = loss_sum / static_cast<double>(since);
      loss_sum = 0.0;
      point = {"cnn",
               position.iteration,
               position.iteration * settings.cnn_batch,
               position.seconds,
               rate,
               last_loss,
               0,
               0,
               0,
               0};
      validate(cnn, validation, settings, point);
      log.add(point);
    }
    progress.show(
        "cnn", position.iteration * settings.cnn_batch, total * settings.cnn_batch,
        static_cast<double>((position.iteration - first) * settings.cnn_batch) / seconds_since(start),
        "images", last_loss, point.mean_deg);
    if (seconds_since(last_checkpoint) > settings.checkpoint_s) {
      save_checkpoint(path, cnn, optimizer, position);
      last_checkpoint = Clock::now();
    }
  }
  save_checkpoint(path, cnn, optimizer, position);
  progress.finish();
  return position.iteration >= total;
}

}  // namespace tumblesight::sim
