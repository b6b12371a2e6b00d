#include "sim/training/stage.hpp"

#include <ATen/Parallel.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "gnc/numerics/crc.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {

void keep_to_one_thread() {
  at::set_num_threads(1);
  if (void* set_threads = dlsym(RTLD_DEFAULT, "openblas_set_num_threads")) {
    reinterpret_cast<void (*)(int)>(set_threads)(1);
  }
}

bool cpu_has_bfloat16() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("flags", 0) == 0) {
      return line.find("avx512_bf16") != std::string::npos || line.find("amx_bf16") != std::string::npos;
    }
  }
  return false;
}

std::int64_t fingerprint(std::initializer_list<std::uint64_t> settings) {
  gnc::Crc32 crc;
  for (const std::uint64_t value : settings) {
    crc.add_u32(static_cast<std::uint32_t>(value));
    crc.add_u32(static_cast<std::uint32_t>(value >> 32));
  }
  return crc.value();
}

std::uint64_t bits_of(double setting) {
  std::uint64_t bits;
  std::memcpy(&bits, &setting, sizeof bits);
  return bits;
}

Stage::Stage(const StageSettings& settings) : settings_(settings) {
  position_.fingerprint = settings.fingerprint;
  // Of a timed stage the fingerprint leaves the time open.
  const std::vector<std::int64_t> all = settings_.ranks->gather(
      fingerprint({static_cast<std::uint64_t>(settings.fingerprint), bits_of(settings.seconds),
                   static_cast<std::uint64_t>(settings.trainers)}));
  for (std::size_t rank = 1; rank < all.size(); ++rank) {
    if (all[rank] == all[0]) continue;
    throw std::runtime_error(
        "the ranks have different settings: rank " + std::to_string(rank) +
        " was started with other settings (meshes, target, conditions, effects, sensor, "
        "ranges, seed, rates, precision, time, trainers, numbers of samples) than rank 0");
  }
}

void Stage::start() {
  last_save_ = Clock::now();
  if (start_ == Clock::time_point{}) start_ = last_save_;
  if (!leads()) return;
  log_ = std::make_unique<TrainingLog>(settings_.folder, settings_.name, position_.iteration);
  const bool timed = settings_.seconds > 0.0;
  progress_ = std::make_unique<ProgressBar>(
      settings_.name, timed ? "s" : settings_.unit,
      timed ? whole_seconds(settings_.seconds) : units(settings_.iterations), stderr, done());
}

void Stage::set_rate(torch::optim::Optimizer& optimizer) {
  constexpr double kWarmUp = 200.0;  // iterations
  constexpr double kWarmUpShare = 0.1;
  const double done = static_cast<double>(position_.iteration + 1);
  // A short stage with a time of its own has few iterations.
  const double of_time = settings_.seconds > 0.0 ? fraction() / kWarmUpShare : 0.0;
  const double warm = std::min(1.0, std::max(done / kWarmUp, of_time));
  rate_ = 0.5 * settings_.learning_rate * (1.0 + std::cos(kPi * fraction())) * warm;
  for (auto& group : optimizer.param_groups()) group.options().set_lr(rate_);
}

double Stage::fraction() const {
  if (settings_.seconds > 0.0)
    return std::min(1.0, position_.seconds / settings_.seconds + position_.skipped);
  return std::min(1.0, static_cast<double>(position_.iteration) / static_cast<double>(settings_.iterations));
}

std::uint64_t Stage::done() const {
  return settings_.seconds > 0.0 ? whole_seconds(fraction() * settings_.seconds) : units(position_.iteration);
}

void Stage::advance(double loss) {
  ++position_.iteration;
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  position_.seconds = seconds_before_ + seconds;
  // Where it decides on the learning rate and the end.
  if (settings_.seconds > 0.0) position_.seconds = settings_.ranks->of_first(position_.seconds);
  loss_sum_ += loss;
  ++losses_;
  if (progress_) progress_->update(done(), progress_note(latest_));
}

std::string progress_note(const std::optional<TrainingPoint>& latest) {
  if (!latest) return {};
  return fmt::format("loss {:.4f}  validation {:.2f} deg", latest->loss, latest->mean_deg);
}

bool Stage::point_due() const {
  return position_.iteration % settings_.iterations_per_point == 0 || finished();
}

TrainingPoint Stage::new_point() {
  TrainingPoint point;
  point.stage = settings_.name;
  point.iteration = position_.iteration;
  point.samples = position_.iteration * settings_.batch;
  point.seconds = position_.seconds;
  point.learning_rate = rate_;
  point.loss = loss_sum_ / static_cast<double>(std::max<std::int64_t>(1, losses_));
  loss_sum_ = 0.0;
  losses_ = 0;
  return point;
}

bool Stage::add_point(const TrainingPoint& point) {
  latest_ = point;
  if (log_) log_->add(point);
  if (progress_) progress_->update(done(), progress_note(latest_));
  // Ranks on different processors may differ in its last bits, and would end at different iterations.
  const double mean_deg = settings_.ranks->of_first(point.mean_deg);
  if (mean_deg >= position_.least_mean_deg) {
    skip_if_nothing_improves();
    return false;
  }
  position_.least_mean_deg = mean_deg;
  position_.fraction_of_best = fraction();
  return true;
}

void Stage::skip_if_nothing_improves() {
  const double now = fraction();
  if (settings_.seconds == 0.0 || now >= kLastPart || now - position_.fraction_of_best <= kPatience) return;
  position_.skipped += kLastPart - now;
}

}  // namespace tumblesight::sim
