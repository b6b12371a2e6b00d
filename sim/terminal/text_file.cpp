#include "sim/terminal/text_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace tumblesight::sim {

void write_text_file(const std::string& path, const std::string& content) {
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  std::error_code error;
  if (!parent.empty()) std::filesystem::create_directories(parent, error);
  if (error) throw std::runtime_error("cannot create folder '" + parent.string() + "': " + error.message());
  // Written under another name, then renamed, so that a reader never finds a part of the file.
  const std::string partial = path + "." + std::to_string(getpid()) + ".partial";
  errno = 0;
  std::ofstream file(partial, std::ios::binary);
  file << content;
  file.close();
  const int reason = errno;
  if (!file || std::rename(partial.c_str(), path.c_str()) != 0) {
    const std::string message = std::strerror(reason != 0 ? reason : errno);
    std::filesystem::remove(partial, error);
    throw std::runtime_error("cannot write '" + path + "': " + message);
  }
}

}  // namespace tumblesight::sim
