// Runs the host tool as a user would and catches what it says; and a folder for its files.
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

#include "tests/support/arbitrary_model.hpp"

namespace tumblesight::sim {

struct Outcome {
  int exit_code = -1;
  std::string output;
  std::string errors;
};

inline std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Deleted with all it holds when this goes out of scope.
class Workplace {
 public:
  Workplace() {
    std::string pattern = (std::filesystem::temp_directory_path() / "tumblesight_cli_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~Workplace() { std::filesystem::remove_all(folder_); }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string model(const char* target = "near_shoemaker", std::uint32_t swath_mm = 7000) const {
    const std::vector<std::uint8_t> image = arbitrary_model(target, swath_mm);
    std::ofstream file(path("model.tsm"), std::ios::binary);
    file.write(reinterpret_cast<const char*>(image.data()), static_cast<std::streamsize>(image.size()));
    return path("model.tsm");
  }

  // A program in this folder that runs `lines` in a shell; gives its path.
  std::string script(const std::string& name, const std::string& lines) const {
    std::ofstream(path(name)) << "#!/bin/sh\n" << lines << "\n";
    std::filesystem::permissions(path(name), std::filesystem::perms::owner_all);
    return path(name);
  }

  // What it prints is in <name>.out and <name>.err from the start.
  Outcome run(const std::string& arguments, const std::string& name = "run") const {
    return run_command(std::string("timeout 60 ") + TUMBLESIGHT_BINARY + " " + arguments, name);
  }
  Outcome run_command(const std::string& command, const std::string& name) const {
    const std::string out = path(name + ".out");
    const std::string err = path(name + ".err");
    const int status =
        std::system(("cd " + folder_.string() + " && " + command + " >" + out + " 2>" + err).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(out), content(err)};
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace tumblesight::sim
