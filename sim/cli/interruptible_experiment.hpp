// Experiments that a signal ends, after the sequences that are under way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>

#include "sim/experiment/experiment.hpp"

namespace tumblesight::sim {

struct Interrupted : std::exception {
  const char* what() const noexcept override { return "interrupted"; }
};

std::size_t sequences_of(const ExperimentSettings& settings);

// As run_experiment(). `figures` takes every sequence, and `sequences` counts them. Throws Interrupted after
// a sequence, except the last one, if a signal has come (Interruption).
void run_until_signal(const Subject& subject, const ExperimentSettings& settings, ExperimentFigures& figures,
                      std::size_t& sequences, const std::function<void(std::uint64_t)>& progress);

}  // namespace tumblesight::sim
