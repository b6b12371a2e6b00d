#include "sim/cli/option_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "sim/cli/command.hpp"
#include "sim/host/place.hpp"
#include "sim/host/write_file.hpp"

namespace tumblesight::sim {
std::string full_path(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path absolute = fs::absolute(path, error);
  // weakly_canonical() leaves a link to a file that does not exist yet as it is.
  constexpr int kMostLinks = 40;
  for (int i = 0; i < kMostLinks && fs::is_symlink(absolute, error) && !fs::exists(absolute, error); ++i)
    absolute = absolute.parent_path() / fs::read_symlink(absolute, error);
  const fs::path full = fs::weakly_canonical(absolute, error);
  return (error ? absolute.lexically_normal() : full).string();
}

bool is_same_file(const std::string& path, const std::string& other) {
  std::error_code error;
  return !path.empty() && !other.empty() &&
         (full_path(path) == full_path(other) || std::filesystem::equivalent(path, other, error));
}

void require_separate_files(const OptionFiles& read, const OptionFiles& written) {
  OptionFiles others = read;
  for (const OptionFile& file : written) {
    for (const OptionFile& other : others) {
      if (!is_same_file(file.path, other.path)) continue;
      throw ArgumentFault(file.option, fmt::format("'{}' is also the file of {}; give two different files",
                                                   file.path, other.option));
    }
    others.push_back(file);
  }
}

void require_usable_files(const OptionFiles& read, const OptionFiles& written) {
  require_separate_files(read, written);
  for (const auto& [option, path] : written) {
    if (!path.empty()) require_writable(option, path);
  }
}

void require_folder(const std::string& option, const std::string& path) {
  namespace fs = std::filesystem;
  const auto refuse = [&](const std::string& reason) {
    throw std::runtime_error(fmt::format("{} {}: {}", option, path, reason));
  };
  std::error_code error;
  const std::string fault = Place(path).fault();
  if (!fault.empty()) refuse(fault);
  if (fs::exists(path, error) && !fs::is_directory(path, error)) refuse("is a file; give a folder");
  fs::create_directories(path, error);
  if (error) refuse("cannot be created: " + error.message());
  if (access(path.c_str(), W_OK) != 0)
    refuse(fmt::format("cannot be written: {}; choose another folder", std::strerror(errno)));
}

void require_writable(const std::string& option, const std::string& path) {
  namespace fs = std::filesystem;
  const auto refuse = [&](const std::string& reason) {
    throw std::runtime_error(fmt::format("{} {}: {}", option, path, reason));
  };
  std::error_code error;
  if (fs::is_directory(path, error)) refuse("is a folder; give a file name");
  const fs::path name = fs::path(path).filename();
  if (name.empty() || name == "." || name == "..") refuse("ends as a folder does; add a file name");
  // Before a folder is made where a link of another user leads.
  const std::string fault = fault_of_place(path);
  if (!fault.empty()) refuse(fault);
  const fs::path parent = fs::absolute(path).parent_path();
  fs::create_directories(parent, error);
  if (error) refuse("cannot create its folder: " + error.message() + "; choose another folder");
  const bool exists = fs::exists(path, error);
  if (exists && access(path.c_str(), W_OK) != 0)
    refuse(fmt::format("cannot be written: {}; choose another file", std::strerror(errno)));
  const std::string reason = fault_of_new_file(path);
  if (!reason.empty()) refuse(reason);
}

}  // namespace tumblesight::sim
