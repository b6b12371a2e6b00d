#include "sim/host/write_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "sim/host/place.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kPartialNames = 16;

std::string partial_name(const std::string& name) {
  return name + "." + std::to_string(getpid()) + ".partial";
}

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw std::runtime_error("cannot write '" + path + "': " + reason);
}

struct Partial {
  std::string name;  // in the folder of the place
  int file = -1;     // below 0: there is none, and errno says why
};

// A file of this process alone, whatever another user has put under names like it.
Partial open_partial(const Place& place) {
  const std::string name = partial_name(place.name());
  Partial made;
  errno = ENOENT;
  if (place.folder() < 0) return made;
  for (int i = 0; i < kPartialNames; ++i) {
    made.name = name + (i == 0 ? "" : std::to_string(i));
    made.file =
        openat(place.folder(), made.name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (made.file >= 0 || errno != EEXIST) break;
  }
  return made;
}

std::string text_of_partial_error(const std::string& path, int error) {
  if (error != EEXIST) return std::strerror(error);
  return "all names for the file that is written first are taken; delete " + partial_name(path) + "*";
}

// Takes the file. Throws std::runtime_error.
void put(const std::string& path, int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t count = ::write(file, content.data(), content.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const std::string reason = count == 0 ? "nothing more is taken" : std::strerror(errno);
      close(file);
      fail(path, reason);
    }
    content.remove_prefix(static_cast<std::size_t>(count));
  }
  if (close(file) != 0) fail(path, std::strerror(errno));
}

class PartialFile {
 public:
  // Throws std::runtime_error if it cannot be made.
  PartialFile(const std::string& path, const Place& place) : path_(path), place_(place) {
    Partial made = open_partial(place);
    if (made.file < 0) fail(path, text_of_partial_error(path, errno));
    name_ = std::move(made.name);
    file_ = made.file;
  }
  ~PartialFile() {
    if (!name_.empty()) unlinkat(place_.folder(), name_.c_str(), 0);
  }
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  void become(std::string_view content) {
    put(path_, file_, content);
    if (renameat(place_.folder(), name_.c_str(), place_.folder(), place_.name().c_str()) != 0)
      fail(path_, std::strerror(errno));
    name_.clear();
  }

 private:
  const std::string& path_;
  const Place& place_;
  std::string name_;
  int file_ = -1;
};

// Held until the program ends: the reader would take the end of this look for the end of the content.
std::string fault_of_pipe(const Place& place) {
  if (place.type() != S_IFIFO || place.is_of_kernel()) return {};
  try {
    (void)open_place(place);
    return {};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

}  // namespace

std::string fault_of_place(const std::string& path) {
  const Place place(path);
  return place.fault().empty() ? fault_of_pipe(place) : place.fault();
}

std::string fault_of_new_file(const std::string& path) {
  const Place place(path);
  if (!place.fault().empty()) return place.fault();
  if (!place.is_replaceable() && place.type() != 0) return {};
  const Partial made = open_partial(place);
  const int error = errno;
  if (made.file < 0 && error == ENAMETOOLONG) return "the name is too long to be written; give a shorter one";
  if (made.file < 0)
    return "no file can be made in its folder: " + text_of_partial_error(path, error) +
           "; choose another folder";
  close(made.file);
  unlinkat(place.folder(), made.name.c_str(), 0);
  return {};
}

std::string partial_path(const std::string& path) {
  return Place(path).is_replaceable() ? partial_name(path) : "";
}

void write_file(const std::string& path, std::string_view content) {
  const Place place(path, Folders::kMade);
  if (!place.fault().empty()) fail(path, place.fault());
  if (!place.is_replaceable()) return put(path, open_emptied(path, place), content);
  // Written under another name, then renamed, so that a reader never finds a part of the file.
  PartialFile(path, place).become(content);
}

void append_to_file(const std::string& path, std::string_view content) {
  put(path, open_to_write(path, O_WRONLY | O_APPEND), content);
}

void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  write_file(path, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

}  // namespace tumblesight::sim
