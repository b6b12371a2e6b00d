#include "sim/cli/interruptible_experiment.hpp"

#include <csignal>
#include <numeric>
#include <utility>
#include <vector>

namespace tumblesight::sim {
namespace {

volatile std::sig_atomic_t signal_that_came = 0;

void note(int signal) {
  const auto before = std::signal(signal, [](int came) {
    signal_that_came = came;
    std::signal(came, SIG_DFL);
  });
  if (before == SIG_IGN) std::signal(signal, SIG_IGN);
}

}  // namespace

SignalNote::SignalNote() {
  signal_that_came = 0;
  for (const int signal : {SIGINT, SIGTERM}) note(signal);
}

SignalNote::~SignalNote() {
  for (const int signal : {SIGINT, SIGTERM})
    if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
}

int SignalNote::signal() {
  return signal_that_came;
}

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
    if (signal_that_came != 0 && sequences < wanted) throw Interrupted();
  };
  run_chosen(subject, settings, all, take, progress);
}

}  // namespace tumblesight::sim
