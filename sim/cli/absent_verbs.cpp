#include "sim/cli/absent_verbs.hpp"

#include <fmt/format.h>

#include "sim/cli/arguments.hpp"
#include "sim/terminal/text.hpp"

namespace tumblesight::sim {
namespace {

struct NeedOfVerb {
  const char* verb;
  const char* packages;  // Debian's; nullptr: none beyond those of every build
  const char* option;    // of CMake, besides; nullptr: none
};

constexpr const char* kSil = "-DTUMBLESIGHT_SIL=ON";
constexpr const char* kTraining =
    "-DTUMBLESIGHT_TRAINING=ON (cmake --preset train; sim/adopt does all of this)";
constexpr const char* kTrainingPackages = "libtorch-dev, libgloo-dev and libopenblas0-pthread";

// The folders' CMakeLists.txt decide by the same libraries and options.
constexpr NeedOfVerb kNeeds[] = {
    {"simulate", nullptr, kSil},
    {"replay", nullptr, kSil},
    {"console", "libcivetweb-dev", nullptr},
    {"export", "libonnx-dev and libprotobuf-dev", nullptr},
    {"adopt", kTrainingPackages, kTraining},
    {"train", kTrainingPackages, kTraining},
};

bool has(const CLI::App& app, const std::string& verb) {
  return !app.get_subcommands([&verb](const CLI::App* one) { return one->get_name() == verb; }).empty();
}

std::string remedy_of(const CLI::App& app, const NeedOfVerb& need) {
  const std::string verb = need.verb;
  const bool lacks_sil = (verb == "console" || verb == "adopt") && !has(app, "simulate");
  std::string remedy = need.packages != nullptr ? fmt::format("install {} and ", need.packages) : "";
  remedy += "configure again";
  if (need.option != nullptr) remedy += fmt::format(" with {}", need.option);
  if (lacks_sil) remedy += fmt::format(" {} {}", need.option != nullptr ? "and" : "with", kSil);
  return remedy;
}

}  // namespace

std::string fault_of_absent_verb(const CLI::App& app, const std::string& verb) {
  for (const NeedOfVerb& need : kNeeds) {
    if (need.verb == verb && !has(app, verb))
      return fmt::format("this build has no {}: {}", verb, remedy_of(app, need));
  }
  return {};
}

std::string absent_verbs_text(const CLI::App& app) {
  std::string text;
  for (const NeedOfVerb& need : kNeeds) {
    if (!has(app, need.verb))
      text += wrapped(fmt::format("{}: {}", need.verb, remedy_of(app, need)), kHelpWidth) + "\n";
  }
  return text.empty() ? text : "\nNot in this build\n" + text;
}

}  // namespace tumblesight::sim
