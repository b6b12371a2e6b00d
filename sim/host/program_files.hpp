// The files of the running program: where it lies, where the data that ships with it is, and where it writes
// by default.
#pragma once

#include <filesystem>
#include <string>

namespace tumblesight::sim {

// An installed program lies in <prefix>/bin beside <prefix>/share/tumblesight, its data. Any other one lies
// in <build folder>/bin and uses the source tree that it was built from, by a link in the build folder.
struct ProgramFiles {
  bool installed;
  std::string root;      // the data folder or the source tree
  std::string models;    // folder of the model images that ship
  std::string missions;  // folder of the missions of the targets that ship
  std::string sensors;   // folder of the sensor descriptions that ship
  std::string output;    // folder of what a program writes by default: out, of an installed one that in the
                         // current folder
  std::string output_parent;  // where that folder is, for help texts: "the source tree"
};

// Of the running program. Throws std::filesystem::filesystem_error without /proc.
std::filesystem::path program_path();
// `tumblesight`, in the same folder, which starts the programs of all verbs.
std::filesystem::path tool_path();

ProgramFiles files_of_program(const std::filesystem::path& program);
const ProgramFiles& program_files();  // of the running program

}  // namespace tumblesight::sim
