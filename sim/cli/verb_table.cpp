#include "sim/cli/verb_table.hpp"

#include <fmt/format.h>

#include "sim/cli/command_line.hpp"
#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

constexpr const char* kTraining =
    "-DTUMBLESIGHT_TRAINING=ON (cmake --preset train; sim/adopt does all of this)";
constexpr const char* kTrainingPackages = "libtorch-dev, libgloo-dev and libopenblas0-pthread";

}  // namespace

// The folders' CMakeLists.txt decide by the same libraries and options.
const std::vector<Verb>& verbs() {
  static const std::vector<Verb> all{
      {"simulate", "Run the flight program with the simulated sensor over DDS and write a report", nullptr,
       nullptr},
      {"replay", "Run the flight program over a recording and compare its attitudes with the truth", nullptr,
       nullptr},
      {"console", "Watch a run in the browser while it goes on, or a recording of one", "libcivetweb-dev",
       nullptr},
      {"mesh", "Show what a mesh file holds, and what to correct before training", nullptr, nullptr},
      {"evaluate", "Measure the accuracy of a model over many sequences, without the flight program", nullptr,
       nullptr},
      {"merge", "Make the figures of an evaluation from the shard files of `evaluate --shard`", nullptr,
       nullptr},
      {"campaign", "Run many evaluations on all cores, by mpirun, or on a Slurm cluster", nullptr, nullptr},
      {"quantize", "Make the fixed-point model image that flies from a float32 one", nullptr, nullptr},
      {"record", "Render frames into a recording, with their truth beside it", nullptr, nullptr},
      {"export", "Write a float32 model image as ONNX models", "libonnx-dev and libprotobuf-dev", nullptr},
      {"adopt", "Train, judge and fly a network for your spacecraft, from one mission file",
       kTrainingPackages, kTraining},
      {"train", "Train a network for a target and write its model images", kTrainingPackages, kTraining},
      {"bench", "Measure the speed of the flight network, compared with other runtimes", nullptr, nullptr},
  };
  return all;
}

const Verb* verb_named(const std::string& name) {
  for (const Verb& verb : verbs())
    if (verb.name == name) return &verb;
  return nullptr;
}

std::string remedy_for_absent(const Verb& verb) {
  std::string remedy = verb.packages != nullptr ? fmt::format("install {} and ", verb.packages) : "";
  remedy += "configure again";
  if (verb.option != nullptr) remedy += fmt::format(" with {}", verb.option);
  return remedy;
}

std::string remedy_for_unbuilt(const Verb& verb, const std::string& build) {
  return fmt::format("cmake --build {} --target tumblesight-{}", shell_word(build), verb.name);
}

std::string absent_verbs_text(const std::vector<Verb>& absent) {
  std::string text;
  for (const Verb& verb : absent)
    text += wrapped(fmt::format("{}: {}", verb.name, remedy_for_absent(verb)), kHelpWidth) + "\n";
  return text.empty() ? text : "\nNot in this build\n" + text;
}

}  // namespace tumblesight::sim
