// TrainingLog: what a training run did: a CSV that grows line by line, a loss curve as SVG, a line on the
// terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace tumblesight::sim {

struct TrainingPoint {
  std::string stage;  // "cnn" or "rcnn"
  std::int64_t iteration = 0;
  std::int64_t samples = 0;  // images or sequences seen
  double seconds = 0.0;      // spent on this stage, over all its resumptions
  double learning_rate = 0.0;
  double loss = 0.0;      // mean since the last point
  double best_deg = 0.0;  // validation: the nearest of the hypotheses
  double mean_deg = 0.0;  // validation: the chosen one
  double median_deg = 0.0;
  double within_20deg = 0.0;
};

class TrainingLog {
 public:
  // Continues `folder`/log.csv if it exists, dropping points of `stage` after `last_iteration` (a run that
  // was killed after its last checkpoint repeats them). Throws std::runtime_error when the folder cannot be
  // written.
  TrainingLog(const std::string& folder, const std::string& stage, std::int64_t last_iteration);
  void add(const TrainingPoint& point);  // appends to the CSV and redraws the curve

 private:
  void draw() const;
  std::string folder_;
  std::vector<TrainingPoint> points_;
};

// One line that stays in place on a terminal, and is printed every half minute elsewhere.
class ProgressLine {
 public:
  void show(const std::string& stage, std::int64_t done, std::int64_t total, double per_second,
            const char* unit, double loss, double validation_deg);
  void wait(const std::string& stage, const char* for_what, std::int64_t done, std::int64_t total);
  void finish();

 private:
  bool due();
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace tumblesight::sim
