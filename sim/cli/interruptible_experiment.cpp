#include "sim/cli/interruptible_experiment.hpp"

#include <numeric>
#include <utility>
#include <vector>

#include "sim/host/interruption.hpp"

namespace tumblesight::sim {
std::size_t sequences_of(const ExperimentSettings& settings) {
  std::size_t sequences = 0;
  for (const ExperimentRun& run : runs_of(settings)) sequences += run.sequences;
  return sequences;
}

void run_until_signal(const Subject& subject, const ExperimentSettings& settings, ExperimentFigures& figures,
                      std::size_t& sequences, const std::function<void(std::uint64_t)>& progress) {
  const auto all = [](std::size_t, const ExperimentRun& run) {
    std::vector<std::uint32_t> indices(run.sequences);
    std::iota(indices.begin(), indices.end(), 0U);
    return indices;
  };
  const std::size_t wanted = sequences_of(settings);
  const auto take = [&](std::size_t run, SequenceResult&& result) {
    figures.add(run, std::move(result));
    ++sequences;
    if (Interruption::signal() != 0 && sequences < wanted) throw Interrupted();
  };
  run_chosen(subject, settings, all, take, progress);
}

}  // namespace tumblesight::sim
