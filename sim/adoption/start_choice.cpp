#include "sim/adoption/start_choice.hpp"

#include <algorithm>
#include <filesystem>

#include "sim/training/train.hpp"

namespace tumblesight::sim {

std::vector<StartTrial> start_trials(const TrainingTargets& targets, const TrainingSettings& settings,
                                     const std::vector<std::string>& candidates, std::int64_t images,
                                     const std::string& folder, const std::atomic<bool>& stop) {
  std::vector<StartTrial> trials;
  for (const std::string& image : candidates) {
    TrainingSettings trial = settings;
    trial.folder = folder + "/" + std::filesystem::path(image).stem().stem().string();
    std::filesystem::create_directories(trial.folder);
    trial.start_from = image;
    trial.cnn_seconds = 0.0;
    trial.cnn_images = images;
    double mean_deg = 180.0;
    trial.after_point = [&mean_deg](const TrainingPoint& point, bool) { mean_deg = point.mean_deg; };
    Cnn cnn;
    if (!train_cnn(targets, trial, cnn, stop)) return {};
    trials.push_back({image, mean_deg});
    std::filesystem::remove_all(trial.folder);
  }
  std::stable_sort(trials.begin(), trials.end(),
                   [](const StartTrial& a, const StartTrial& b) { return a.mean_deg < b.mean_deg; });
  return trials;
}

}  // namespace tumblesight::sim
