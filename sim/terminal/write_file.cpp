#include "sim/terminal/write_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace tumblesight::sim {
namespace fs = std::filesystem;
namespace {

// Whether the path may be replaced by another file: a device, a pipe or a link has to stay what it is.
bool replaceable(const std::string& path) {
  std::error_code ignored;
  const fs::file_type type = fs::symlink_status(path, ignored).type();
  return type == fs::file_type::not_found || type == fs::file_type::regular;
}

}  // namespace

std::string partial_path(const std::string& path) {
  return replaceable(path) ? path + "." + std::to_string(getpid()) + ".partial" : "";
}

void write_file(const std::string& path, std::string_view content) {
  const fs::path parent = fs::path(path).parent_path();
  std::error_code error;
  if (!parent.empty()) fs::create_directories(parent, error);
  if (error) throw std::runtime_error("cannot create folder '" + parent.string() + "': " + error.message());
  // Written under another name, then renamed, so that a reader never finds a part of the file.
  const std::string partial = partial_path(path);
  const bool renamed = !partial.empty();
  const std::string& written = renamed ? partial : path;
  errno = 0;
  std::ofstream file(written, std::ios::binary);
  file << content;
  file.close();
  const int reason = errno;
  if (!file || (renamed && std::rename(written.c_str(), path.c_str()) != 0)) {
    const std::string message = std::strerror(reason != 0 ? reason : errno);
    if (renamed) fs::remove(written, error);
    throw std::runtime_error("cannot write '" + path + "': " + message);
  }
}

void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  write_file(path, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

}  // namespace tumblesight::sim
