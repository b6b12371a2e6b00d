// TrainingLog: the course of a training run, as a CSV file that grows line by line and as a figure of the
// validation error.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tumblesight::sim {

struct TrainingPoint {
  std::string stage;  // "cnn" or "rcnn"
  std::int64_t iteration = 0;
  std::int64_t samples = 0;  // images or sequences processed
  double seconds = 0.0;      // time of this stage, including earlier runs that it continues
  double learning_rate = 0.0;
  double loss = 0.0;      // mean since the last point
  double best_deg = 0.0;  // validation error of the best hypothesis
  double mean_deg = 0.0;  // validation error of the chosen hypothesis
  double median_deg = 0.0;
  double within_20deg = 0.0;
};

// The points in `folder`/log.csv; none if there is no such file.
std::vector<TrainingPoint> read_training_log(const std::string& folder);

class TrainingLog {
 public:
  // Continues `folder`/log.csv if it exists. Points of `stage` after `last_iteration` are removed: a run that
  // was killed after its last checkpoint repeats them. Throws std::runtime_error if the folder cannot be
  // written.
  TrainingLog(const std::string& folder, const std::string& stage, std::int64_t last_iteration);
  void add(const TrainingPoint& point);  // appends to log.csv and rewrites curve.svg

 private:
  std::string folder_;
  std::vector<TrainingPoint> points_;
};

}  // namespace tumblesight::sim
