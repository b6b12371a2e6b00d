#include "sim/terminal/write_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace tumblesight::sim {
namespace fs = std::filesystem;
namespace {

// Whether the path may be replaced by another file: a device, a pipe or a link has to stay what it is.
bool replaceable(const std::string& path) {
  std::error_code ignored;
  const fs::file_type type = fs::symlink_status(path, ignored).type();
  return type == fs::file_type::not_found || type == fs::file_type::regular;
}

// A file of this process alone, whatever another user has put under names like it. Throws if there is none.
class PartialFile {
 public:
  explicit PartialFile(const std::string& path) {
    constexpr int kTries = 16;
    for (int i = 0; i < kTries && file_ < 0; ++i) {
      name_ = partial_path(path) + (i == 0 ? "" : std::to_string(i));
      file_ = open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
      if (file_ < 0 && errno != EEXIST) break;
    }
    if (file_ < 0) fail(path);
  }
  ~PartialFile() {
    if (file_ >= 0) close(file_);
    if (!name_.empty()) unlink(name_.c_str());
  }
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  void become(const std::string& path, std::string_view content) {
    while (!content.empty()) {
      const ssize_t count = ::write(file_, content.data(), content.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) fail(path);
      content.remove_prefix(static_cast<std::size_t>(count));
    }
    if (close(std::exchange(file_, -1)) != 0 || std::rename(name_.c_str(), path.c_str()) != 0) fail(path);
    name_.clear();
  }

 private:
  [[noreturn]] static void fail(const std::string& path) {
    throw std::runtime_error("cannot write '" + path + "': " + std::strerror(errno));
  }
  std::string name_;
  int file_ = -1;
};

// A device, an own pipe or a link.
void write_to_what_is_there(const std::string& path, std::string_view content) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file << content;
  file.close();
  if (!file) throw std::runtime_error("cannot write '" + path + "': " + std::strerror(errno));
}

}  // namespace

std::string fault_of_place(const std::string& path) {
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0 || status.st_uid == geteuid()) return {};
  const bool is_link = S_ISLNK(status.st_mode),
             is_pipe = S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode);
  // It leads where the other user wants, or nowhere. Those of root, as /dev/stdout, are the system's.
  if (status.st_uid == 0 || (!is_link && !is_pipe)) return {};
  return std::string("it is a ") + (is_link ? "link" : "pipe") + " of another user; give another path";
}

std::string partial_path(const std::string& path) {
  return replaceable(path) ? path + "." + std::to_string(getpid()) + ".partial" : "";
}

void write_file(const std::string& path, std::string_view content) {
  const fs::path parent = fs::path(path).parent_path();
  std::error_code error;
  if (!parent.empty()) fs::create_directories(parent, error);
  if (error) throw std::runtime_error("cannot create folder '" + parent.string() + "': " + error.message());
  const std::string fault = fault_of_place(path);
  if (!fault.empty()) throw std::runtime_error("cannot write '" + path + "': " + fault);
  if (!replaceable(path)) return write_to_what_is_there(path, content);
  // Written under another name, then renamed, so that a reader never finds a part of the file.
  PartialFile(path).become(path, content);
}

void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  write_file(path, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

}  // namespace tumblesight::sim
