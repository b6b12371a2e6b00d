// Which trained network is nearest to a target that none of them knows.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace tumblesight::sim {

// sim/training/train.hpp. Not included, since LibTorch's headers are slow to read.
struct TrainingTargets;
struct TrainingSettings;

struct StartTrial {
  std::string image;      // path
  double mean_deg = 0.0;  // mean validation error of the CNN after the trial
};

// Trains the CNN of each image on `images` frames of the target and returns them, the best first. The loss
// after a short while orders the candidates better than any likeness of the shapes. `folder`: for checkpoints
// of the trials. Empty if `stop` became true.
std::vector<StartTrial> start_trials(const TrainingTargets& targets, const TrainingSettings& settings,
                                     const std::vector<std::string>& candidates, std::int64_t images,
                                     const std::string& folder, const std::atomic<bool>& stop);

}  // namespace tumblesight::sim
