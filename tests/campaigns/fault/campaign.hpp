// Campaign: flips one or two bits in a running application and classifies the outcome.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::fault {

// The memory or data that contains the bit.
enum class Place {
  kWeights,
  kActivations,
  kEstimatorState,
  kApplicationState,
  kModelDescriptor,
  kCommand,
  kFrame,
  kTwo,      // two bits at a time: in weights, the estimator's or the application's state, the descriptor
  kSurface,  // vertices, triangles and edges of the target's surface in the model image
};
inline constexpr int kPlaces = 9;
const char* to_string(Place place);

enum class Outcome : std::uint8_t {
  kMasked,        // no attitude was affected, and the flip was not detected
  kRecovered,     // detected; the mode is RUN, and the attitudes are correct again
  kSafe,          // detected; the mode is SAFE
  kFlaggedWrong,  // detected, but the attitudes are still wrong at the end
  kSilentWrong,   // an attitude above 20 degrees off was flagged valid, and was correct without the flip
  kLostCount,     // a command was counted neither as accepted nor as refused
  kCrash,         // the process died
  kHang,          // a trial did not end
  kUnprotected,   // afterwards a further flip is not corrected
  kWrongPose,     // a pose that is more than 5 degrees or 0.5 m off was verified and was not without the flip
};
inline constexpr int kOutcomes = 10;
const char* to_string(Outcome outcome);

struct Trial {
  Outcome outcome = Outcome::kMasked;
  bool changed = false;                // at least one bit of an attitude or a registered attitude
  std::uint8_t cycles_to_recover = 0;  // from the first affected cycle to the next correct attitude
};

// Frames of a few consecutive sequences with their truth. Rendered once.
struct Flight {
  std::vector<gnc::RangeImage> frames;
  std::vector<sim::FrameTruth> truth;
  std::vector<std::uint8_t> model;
  std::string target;
};
Flight make_flight(const std::string& target, const std::string& model_path, int sequences,
                   std::uint64_t seed);

// Trials first ... first + count - 1 of a place. A trial depends only on its number and the seed. The trials
// run in child processes, which may crash.
std::vector<Trial> run_trials(const Flight& flight, Place place, bool protected_, std::uint64_t seed,
                              std::uint32_t first, std::uint32_t count);

}  // namespace tumblesight::fault
