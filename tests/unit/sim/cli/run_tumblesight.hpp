// Runs the ground tool as a user would, in a temporary folder, and keeps its output.
#pragma once

#include <sys/wait.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "sim/cli/exit_status.hpp"
#include "tests/support/sim_models.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tumblesight::sim {

// Exit status of a run with the random weights of model(): the attitudes are guesses.
inline constexpr int kGuessed = kOfNoUse;

struct Outcome {
  int exit_code = -1;
  std::string output;
  std::string errors;
};

inline std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A folder in which the tool runs.
class Workplace : public TemporaryFolder {
 public:
  std::string model(const char* target = "near_shoemaker", std::uint32_t swath_mm = 7000) const {
    return put("model.tsm", arbitrary_model(target, swath_mm));
  }

  // Writes a program that runs `lines` in a shell, and returns its path.
  std::string script(const std::string& name, const std::string& lines) const {
    std::ofstream(path(name)) << "#!/bin/sh\n" << lines << "\n";
    std::filesystem::permissions(path(name), std::filesystem::perms::owner_all);
    return path(name);
  }

  // Its output goes to <name>.out and <name>.err while it runs.
  Outcome run(const std::string& arguments, const std::string& name = "run") const {
    return run_command(std::string("timeout 60 ") + TUMBLESIGHT_BINARY + " " + arguments, name);
  }
  Outcome run_command(const std::string& command, const std::string& name) const {
    const std::string out = path(name + ".out");
    const std::string err = path(name + ".err");
    const int status = std::system(("cd " + path("") + " && " + command + " >" + out + " 2>" + err).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(out), content(err)};
  }
};

}  // namespace tumblesight::sim
