// Campaign: flips single bits in a flying application and says what came of each.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::fault {

// Where the bit lies.
enum class Place {
  kWeights,
  kActivations,
  kEstimatorState,
  kApplicationState,
  kModelDescriptor,
  kCommand,
  kFrame
};
inline constexpr int kPlaces = 7;
const char* to_string(Place place);

enum class Outcome : std::uint8_t {
  kMasked,        // no attitude suffered, and nobody noticed
  kRecovered,     // noticed; the mode is RUN, and the attitudes are right again
  kSafe,          // noticed; the mode is SAFE
  kFlaggedWrong,  // noticed, and at the end still without right attitudes
  kSilentWrong,   // an attitude more than 20 degrees off was flagged valid, where without the flip it was
                  // right
  kLostCount,     // a command was neither counted as accepted nor as refused
  kCrash,         // the process died
  kHang,          // a trial did not end
};
inline constexpr int kOutcomes = 8;
const char* to_string(Outcome outcome);

struct Trial {
  Outcome outcome = Outcome::kMasked;
  bool changed = false;  // an attitude, by a bit or more
  std::uint8_t cycles_to_recover =
      0;  // from the first cycle that suffered to the first right attitude after it
};

// Frames of a few sequences one after the other, with their truth. Rendered once.
struct Flight {
  std::vector<gnc::RangeImage> frames;
  std::vector<sim::FrameTruth> truth;
  std::vector<std::uint8_t> model;
  std::string target;
};
Flight make_flight(const std::string& target, const std::string& model_path, int sequences,
                   std::uint64_t seed);

// Trials first ... first + count - 1 of a place; a trial depends on its number and the seed alone. Each runs
// in a child process, which may die.
std::vector<Trial> run_trials(const Flight& flight, Place place, bool protected_, std::uint64_t seed,
                              std::uint32_t first, std::uint32_t count);

}  // namespace tumblesight::fault
