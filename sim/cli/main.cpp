// tumblesight: lists the verbs of the ground tool, and starts the program of one, tumblesight-VERB beside it.
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "sim/cli/command_line.hpp"
#include "sim/cli/exit_status.hpp"
#include "sim/cli/verb_program.hpp"
#include "sim/cli/verb_table.hpp"
#include "sim/host/program_files.hpp"

namespace {

namespace fs = std::filesystem;
using namespace tumblesight::sim;

fs::path program_of(const Verb& verb) {
  return program_path().parent_path() / (std::string("tumblesight-") + verb.name);
}

bool is_built(const Verb& verb) {
  std::error_code error;
  return fs::exists(program_of(verb), error);
}

// Whether the libraries that it needs were there when this build was configured.
bool is_in_build(const Verb& verb) {
  constexpr const char* kVerbsOfBuild[] = {TUMBLESIGHT_VERBS};
  const auto is_it = [&verb](const char* name) { return std::strcmp(name, verb.name) == 0; };
  return std::any_of(std::begin(kVerbsOfBuild), std::end(kVerbsOfBuild), is_it);
}

std::string fault_of(const Verb& verb) {
  const std::string name = verb.name;
  if (!is_in_build(verb)) return "this build has no " + name + ": " + remedy_for_absent(verb);
  if (program_files().installed)
    return "the program tumblesight-" + name + " is missing: install the package again";
  const std::string build = program_path().parent_path().parent_path();
  return name + " is not built yet: " + remedy_for_unbuilt(verb, build) + ", or sim/run " + name;
}

// Returns only if it fails.
int start(const Verb& verb, char** argv) {
  if (!is_built(verb)) {
    const int status = report_fault(fault_of(verb));
    return program_files().installed ? kFailed : status;
  }
  const fs::path program = program_of(verb);
  execv(program.c_str(), argv);
  std::fprintf(stderr, "tumblesight: %s: %s\n", program.c_str(), std::strerror(errno));
  return kFailed;
}

void add_verbs_of_build(Command& tool) {
  std::vector<Verb> absent;
  for (const Verb& verb : verbs()) {
    if (is_in_build(verb))
      tool.add_subcommand(verb.name, verb.summary);
    else
      absent.push_back(verb);
  }
  tool.footer(
      "\nStart with\n  tumblesight simulate\n"
      "and see `tumblesight SUBCOMMAND --help` for the options of each.\n" +
      absent_verbs_text(absent));
}

}  // namespace

int main(int argc, char** argv) {
  prepare_program();
  if (const Verb* verb = argc > 1 ? verb_named(argv[1]) : nullptr) return start(*verb, argv);
  CommandLine line("Tumblesight: attitude of tumbling spacecraft from flash-LiDAR frames.",
                   "version, commit, model format and interface hash");
  try {
    add_verbs_of_build(line.command());
    return finish_output(line.run({argv + 1, argv + std::max(argc, 1)}));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tumblesight: %s\n", error.what());
    return kFailed;
  }
}
