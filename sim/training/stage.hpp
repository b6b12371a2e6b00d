// Stage: the part that both training stages share: position, learning rate, log, progress and checkpoints.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>

#include "sim/host/progress.hpp"
#include "sim/training/checkpoint.hpp"
#include "sim/training/ranks.hpp"
#include "sim/training/training_log.hpp"

namespace tumblesight::sim {

// Applies to everything that the calling thread computes from now on. While other threads render, LibTorch's
// own threads mostly wait for each other. OpenBLAS's threads wait by spinning, which costs a quarter of the
// training's time.
void keep_to_one_thread();

// Whether bfloat16 convolutions are fast: oneDNN has kernels for these x86 extensions.
bool cpu_has_bfloat16();

struct StageSettings {
  std::string name;  // "cnn" or "rcnn": in the checkpoint's file name and in the log
  std::string folder;
  std::int64_t iterations = 0;  // of a stage without a time of its own
  double seconds = 0.0;         // wall-clock time of the stage; 0: it ends after its iterations
  int batch = 0;
  const char* unit = "";  // of the progress: "images" or "batches", as the option counts
  int units_per_batch = 1;
  double learning_rate = 0.0;             // maximum: short linear warm-up, then a cosine to zero
  std::int64_t iterations_per_point = 0;  // between points of the log
  double checkpoint_s = 0.0;              // wall-clock time between checkpoints
  std::int64_t fingerprint = 0;
  int trainers = 1;  // of each rank; not part of the fingerprint
  std::shared_ptr<Ranks> ranks = std::make_shared<Ranks>();
};

// Hash of the settings that affect a stage's result. A checkpoint of other settings is refused.
std::int64_t fingerprint(std::initializer_list<std::uint64_t> settings);
std::uint64_t bits_of(double setting);  // for fingerprint()
// In place of a number of samples, in a stage with a time of its own: the time may change.
inline constexpr std::uint64_t kTimed = ~std::uint64_t{0};

// The figures of the latest point, beside the progress. Empty before the first one.
std::string progress_note(const std::optional<TrainingPoint>& latest);

class Stage {
 public:
  // Throws std::runtime_error if the ranks have different settings.
  explicit Stage(const StageSettings& settings);

  // Restores module, optimizer and position from the checkpoint of rank 0. Returns false if there is none;
  // then all ranks have the module of rank 0.
  template <typename Module>
  bool resume(Module& module, torch::optim::Optimizer& optimizer) {
    const std::string content = settings_.ranks->of_first(leads() ? read_checkpoint(path()) : "");
    const bool found = load_checkpoint(path(), content, module, optimizer, position_);
    seconds_before_ = position_.seconds;
    equalize(module);
    return found;
  }
  // Gives all ranks the module of rank 0: ranks on different processors may differ in rounding.
  template <typename Module>
  void equalize(const Module& module) {
    settings_.ranks->copy_from_first(module->parameters());
    settings_.ranks->copy_from_first(module->buffers());
  }
  // Starts the clock of a stage with a time of its own, for what it prepares before start().
  void start_clock() { start_ = Clock::now(); }
  void start();  // opens the log; starts the clock unless it runs

  std::int64_t iteration() const { return position_.iteration; }
  double fraction() const;  // of the stage that is done, 0..1
  bool finished() const { return fraction() >= 1.0; }
  // Whether a rank shall stop. Several ranks ask each other every few iterations only, since that takes time.
  bool stops(bool own) const {
    constexpr std::int64_t kIterationsPerQuestion = 8;
    if (settings_.ranks->count() > 1 && position_.iteration % kIterationsPerQuestion != 0) return false;
    return settings_.ranks->any(own);
  }
  void set_rate(torch::optim::Optimizer& optimizer);  // for the next iteration

  void advance(double loss);  // after every iteration
  bool point_due() const;
  TrainingPoint new_point();  // the caller fills in the validation figures
  // Returns whether its mean error is the least so far.
  bool add_point(const TrainingPoint& point);

  template <typename Module>
  void save_if_due(const Module& module, const torch::optim::Optimizer& optimizer) {
    if (leads() && Clock::now() - last_save_ > std::chrono::duration<double>(settings_.checkpoint_s))
      save(module, optimizer);
  }
  template <typename Module>
  void save(const Module& module, const torch::optim::Optimizer& optimizer) {
    if (leads()) save_checkpoint(path(), module, optimizer, position_);
    last_save_ = Clock::now();
  }
  void finish_progress() {
    if (progress_) progress_->finish();
  }

 private:
  using Clock = std::chrono::steady_clock;
  // A stage with a time of its own that has not improved for kPatience of it goes on at kLastPart, with the
  // rates of the end of a stage.
  static constexpr double kPatience = 0.35;
  static constexpr double kLastPart = 0.8;
  bool leads() const { return settings_.ranks->leads(); }
  void skip_if_nothing_improves();
  std::uint64_t units(std::int64_t iterations) const {
    return static_cast<std::uint64_t>(iterations * settings_.units_per_batch);
  }
  static std::uint64_t whole_seconds(double seconds) {
    return static_cast<std::uint64_t>(std::ceil(seconds));
  }
  std::uint64_t done() const;  // for the progress: units, or seconds of a stage with a time of its own
  std::string path() const { return settings_.folder + "/" + settings_.name + ".ckpt"; }

  StageSettings settings_;
  CheckpointPosition position_;
  double seconds_before_ = 0.0;
  Clock::time_point start_{}, last_save_{};
  std::unique_ptr<TrainingLog> log_;
  std::unique_ptr<ProgressBar> progress_;
  double rate_ = 0.0;
  double loss_sum_ = 0.0;
  std::int64_t losses_ = 0;
  std::optional<TrainingPoint> latest_;
};

}  // namespace tumblesight::sim
