// The plan of an adoption as a file beside its checkpoints, so that a run that was stopped or killed goes on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sim/adoption/time_plan.hpp"

namespace tumblesight::sim {

struct AdoptionPlan {
  std::uint32_t mission_crc32 = 0;
  double minutes = 0.0;
  std::uint64_t seed = 0;
  std::string start_from;  // empty: random weights
  int trainers = 1;
  TimePlan time;
  double elapsed_s = 0.0;  // when it was last written
};

void write_plan(const std::string& path, const AdoptionPlan& plan);
// Empty if there is none. Throws std::runtime_error that names the file and the remedy if it is of another
// mission, time or seed, or cannot be read.
std::optional<AdoptionPlan> read_plan(const std::string& path, std::uint32_t mission_crc32, double minutes,
                                      std::uint64_t seed);

}  // namespace tumblesight::sim
