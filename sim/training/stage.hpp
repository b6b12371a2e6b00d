// Stage: what both stages of training have in common: position, learning rate, log, progress, checkpoints.
#pragma once

#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>

#include "sim/terminal/progress.hpp"
#include "sim/training/checkpoint.hpp"
#include "sim/training/training_log.hpp"

namespace tumblesight::sim {

struct StageSettings {
  std::string name;  // "cnn" or "rcnn": of the checkpoint and in the log
  std::string folder;
  std::int64_t iterations = 0;
  int batch = 0;
  const char* unit = "";       // what a batch holds
  double learning_rate = 0.0;  // the highest: short linear warm-up, then a cosine to zero
  std::int64_t iterations_per_point = 0;
  double checkpoint_s = 0.0;
  std::int64_t fingerprint = 0;
};

// One number for all the settings that shape a stage's result.
std::int64_t fingerprint(std::initializer_list<std::uint64_t> settings);
std::uint64_t bits_of(double setting);

class Stage {
 public:
  explicit Stage(const StageSettings& settings) : settings_(settings) {
    position_.fingerprint = settings.fingerprint;
  }

  // True if a checkpoint was found: module, optimiser and position are its then.
  template <typename Module>
  bool resume(Module& module, torch::optim::Optimizer& optimizer) {
    const bool found = load_checkpoint(path(), module, optimizer, position_);
    seconds_before_ = position_.seconds;
    return found;
  }
  void start();  // opens the log and starts the clock

  std::int64_t iteration() const { return position_.iteration; }
  bool finished() const { return position_.iteration >= settings_.iterations; }
  void set_rate(torch::optim::Optimizer& optimizer);

  void advance(double loss);  // one more iteration done
  bool point_due() const;
  TrainingPoint new_point();  // its validation figures are the caller's to fill
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
  std::uint64_t samples(std::int64_t iterations) const {
    return static_cast<std::uint64_t>(iterations * settings_.batch);
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
  TrainingPoint latest_;
};

}  // namespace tumblesight::sim
