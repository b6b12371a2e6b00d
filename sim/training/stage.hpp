// Stage: the part that both training stages share: position, learning rate, log, progress and checkpoints.
#pragma once

#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>

#include "sim/terminal/progress.hpp"
#include "sim/training/checkpoint.hpp"
#include "sim/training/training_log.hpp"

namespace tumblesight::sim {

// Applies to everything that the calling thread computes from now on. While other threads render, LibTorch's
// own threads mostly wait for each other. OpenBLAS's threads wait by spinning, which costs a quarter of the
// training's time.
void keep_to_one_thread();

struct StageSettings {
  std::string name;  // "cnn" or "rcnn": in the checkpoint's file name and in the log
  std::string folder;
  std::int64_t iterations = 0;
  int batch = 0;
  const char* unit = "";  // of the progress: "images" or "batches", as the option counts
  int units_per_batch = 1;
  double learning_rate = 0.0;             // maximum: short linear warm-up, then a cosine to zero
  std::int64_t iterations_per_point = 0;  // between points of the log
  double checkpoint_s = 0.0;              // wall-clock time between checkpoints
  std::int64_t fingerprint = 0;
};

// Hash of the settings that affect a stage's result. A checkpoint of other settings is refused.
std::int64_t fingerprint(std::initializer_list<std::uint64_t> settings);
std::uint64_t bits_of(double setting);  // for fingerprint()

// The figures of the latest point, beside the progress. Empty before the first one.
std::string progress_note(const std::optional<TrainingPoint>& latest);

class Stage {
 public:
  explicit Stage(const StageSettings& settings) : settings_(settings) {
    position_.fingerprint = settings.fingerprint;
  }

  // Restores module, optimizer and position from the checkpoint. Returns false if there is none.
  template <typename Module>
  bool resume(Module& module, torch::optim::Optimizer& optimizer) {
    const bool found = load_checkpoint(path(), module, optimizer, position_);
    seconds_before_ = position_.seconds;
    return found;
  }
  void start();  // opens the log and starts the clock

  std::int64_t iteration() const { return position_.iteration; }
  bool finished() const { return position_.iteration >= settings_.iterations; }
  void set_rate(torch::optim::Optimizer& optimizer);  // for the next iteration

  void advance(double loss);  // after every iteration
  bool point_due() const;
  TrainingPoint new_point();  // the caller fills in the validation figures
  void add_point(const TrainingPoint& point);

  template <typename Module>
  void save_if_due(const Module& module, const torch::optim::Optimizer& optimizer) {
    if (Clock::now() - last_save_ > std::chrono::duration<double>(settings_.checkpoint_s))
      save(module, optimizer);
  }
  template <typename Module>
  void save(const Module& module, const torch::optim::Optimizer& optimizer) {
    save_checkpoint(path(), module, optimizer, position_);
    last_save_ = Clock::now();
  }
  void finish_progress() {
    if (progress_) progress_->finish();
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::uint64_t units(std::int64_t iterations) const {
    return static_cast<std::uint64_t>(iterations * settings_.units_per_batch);
  }
  std::string path() const { return settings_.folder + "/" + settings_.name + ".ckpt"; }

  StageSettings settings_;
  CheckpointPosition position_;
  double seconds_before_ = 0.0;
  Clock::time_point start_, last_save_;
  std::unique_ptr<TrainingLog> log_;
  std::unique_ptr<ProgressBar> progress_;
  double rate_ = 0.0;
  double loss_sum_ = 0.0;
  std::int64_t losses_ = 0;
  std::optional<TrainingPoint> latest_;
};

}  // namespace tumblesight::sim
