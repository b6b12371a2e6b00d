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
  // None: it cannot be told, as of a name that is too long; then nothing can be made there either.
  return type == fs::file_type::not_found || type == fs::file_type::regular || type == fs::file_type::none;
}

constexpr int kPartialNames = 16;

struct Partial {
  std::string name;
  int file = -1;  // below 0: there is none, and errno says why
};

// A file of this process alone, whatever another user has put under names like it.
Partial open_partial(const std::string& path) {
  const std::string name = partial_path(path);
  Partial made;
  for (int i = 0; i < kPartialNames; ++i) {
    made.name = name + (i == 0 ? "" : std::to_string(i));
    made.file = open(made.name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (made.file >= 0 || errno != EEXIST) break;
  }
  return made;
}

std::string text_of_partial_error(const std::string& path, int error) {
  if (error != EEXIST) return std::strerror(error);
  return "all names for the file that is written first are taken; delete " + partial_path(path) + "*";
}

class PartialFile {
 public:
  // Throws std::runtime_error if it cannot be made.
  explicit PartialFile(const std::string& path) {
    Partial made = open_partial(path);
    if (made.file < 0) fail(path, text_of_partial_error(path, errno));
    name_ = std::move(made.name);
    file_ = made.file;
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
      if (count <= 0) fail(path, count == 0 ? "nothing more is taken" : std::strerror(errno));
      content.remove_prefix(static_cast<std::size_t>(count));
    }
    if (close(std::exchange(file_, -1)) != 0 || std::rename(name_.c_str(), path.c_str()) != 0)
      fail(path, std::strerror(errno));
    name_.clear();
  }

 private:
  [[noreturn]] static void fail(const std::string& path, const std::string& reason) {
    throw std::runtime_error("cannot write '" + path + "': " + reason);
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

// As Linux's protected_symlinks and protected_fifos, which are not switched on everywhere.
std::string fault_of_place(const std::string& path) {
  const fs::path parent = fs::path(path).parent_path();
  struct stat place {};
  struct stat folder {};
  if (lstat(path.c_str(), &place) != 0 || stat(parent.empty() ? "." : parent.c_str(), &folder) != 0)
    return {};
  // Those of root, as /dev/stdout, are the system's.
  if (place.st_uid == geteuid() || place.st_uid == 0) return {};
  const bool is_shared = (folder.st_mode & (S_ISVTX | S_IWOTH)) != 0;
  const bool is_link = S_ISLNK(place.st_mode), is_pipe = S_ISFIFO(place.st_mode) || S_ISSOCK(place.st_mode);
  const std::string remedy = " of another user; give another path";
  // It leads where the other user wants, or nowhere.
  if ((is_link || is_pipe) && is_shared && place.st_uid != folder.st_uid)
    return std::string("it is a ") + (is_link ? "link" : "pipe") + remedy;
  const bool is_kept = (folder.st_mode & S_ISVTX) != 0 && folder.st_uid != geteuid() && geteuid() != 0;
  return S_ISREG(place.st_mode) && is_kept ? "it is a file" + remedy : "";
}

std::string fault_of_partial_file(const std::string& path) {
  const Partial made = open_partial(path);
  const int error = errno;
  if (made.file < 0 && error == ENAMETOOLONG) return "the name is too long to be written; give a shorter one";
  if (made.file < 0)
    return "no file can be made in its folder: " + text_of_partial_error(path, error) +
           "; choose another folder";
  close(made.file);
  unlink(made.name.c_str());
  return {};
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
