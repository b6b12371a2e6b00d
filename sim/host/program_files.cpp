#include "sim/host/program_files.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

ProgramFiles of_installation(const std::string& data) {
  return {true, data, data + "/models", data + "/missions", data + "/sensors", "out", "the current folder"};
}

ProgramFiles of_source_tree(const std::string& root) {
  return {false,
          root,
          root + "/fsw/models",
          root + "/sim/world/target/missions",
          root + "/sim/world/sensor/descriptions",
          root + "/out",
          "the source tree"};
}

}  // namespace

fs::path program_path() {
  return fs::read_symlink("/proc/self/exe");
}

fs::path tool_path() {
  return program_path().parent_path() / "tumblesight";
}

ProgramFiles files_of_program(const fs::path& program) {
  const fs::path data = (program.parent_path() / TUMBLESIGHT_INSTALLED_DATA).lexically_normal();
  std::error_code error;
  if (fs::is_directory(data, error)) return of_installation(data.string());
  const fs::path source_tree = fs::canonical(program.parent_path() / TUMBLESIGHT_SOURCE_LINK, error);
  // Without either, messages name the data folder that is missing.
  return error ? of_installation(data.string()) : of_source_tree(source_tree.string());
}

const ProgramFiles& program_files() {
  static const ProgramFiles files = files_of_program(program_path());
  return files;
}

}  // namespace tumblesight::sim
