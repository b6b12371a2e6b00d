#include "sim/host/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <limits>

namespace tumblesight::sim {
namespace {

// Of what is not a regular file: what it is, and what to do.
const char* fault_of(mode_t mode) {
  if (S_ISDIR(mode)) return "it is a folder; give a file";
  if (S_ISFIFO(mode)) return "it is a pipe; write its content to a file first";
  if (S_ISSOCK(mode)) return "it is a socket; give a file";
  return "it is a device; give a file";
}

}  // namespace

InputFile::InputFile(const std::string& path, const InputKind& kind) : path_(path), name_(kind.name) {
  // Non-blocking: opening a named pipe would wait for its writer.
  file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (file_ < 0) {
    const int reason = errno;
    if (reason == ENXIO) refuse("it is a socket or has no device; give a file");
    const bool is_missing = reason == ENOENT || reason == ENOTDIR;
    refuse(std::strerror(reason), is_missing);
  }
  struct stat found {};
  const bool is_known = fstat(file_, &found) == 0;
  const std::string fault = !is_known                 ? std::strerror(errno)
                            : !S_ISREG(found.st_mode) ? fault_of(found.st_mode)
                                                      : "";
  size_ = static_cast<std::uint64_t>(found.st_size);
  if (fault.empty() && size_ <= kind.most_bytes) return;
  close(file_);
  if (!fault.empty()) refuse(fault);
  refuse("it has " + std::to_string(size_) + " bytes, and a " + name_ + " has at most " +
         std::to_string(kind.most_bytes) + ": is it another file?");
}

InputFile::~InputFile() {
  close(file_);
}

void InputFile::refuse(const std::string& what, bool is_missing) const {
  const std::string start = name_ + " '" + path_ + "' cannot be read";
  throw InputRefused(start + (is_missing ? "; give an existing file (" + what + ")" : ": " + what),
                     is_missing);
}

std::size_t InputFile::read_at(std::uint64_t offset, void* bytes, std::size_t size) const {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count =
        pread(file_, static_cast<char*>(bytes) + done, size - done, static_cast<off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse(std::strerror(errno));
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  return done;
}

template <class Container>
Container InputFile::content() const {
  Container content;
  content.resize(static_cast<std::size_t>(size_));
  content.resize(read_at(0, content.data(), content.size()));
  return content;
}

std::string InputFile::text() const {
  return content<std::string>();
}

std::vector<std::uint8_t> InputFile::bytes() const {
  return content<std::vector<std::uint8_t>>();
}

std::ifstream InputFile::stream() const {
  std::ifstream stream("/proc/self/fd/" + std::to_string(file_), std::ios::binary);
  if (!stream) refuse(std::strerror(errno));
  return stream;
}

std::string read_text(const std::string& path, const InputKind& kind) {
  return InputFile(path, kind).text();
}

std::vector<std::uint8_t> read_bytes(const std::string& path, const InputKind& kind) {
  return InputFile(path, kind).bytes();
}

std::string fault_of_input(const std::string& path, const InputKind& kind) {
  try {
    const InputFile file(path, kind);
    return {};
  } catch (const InputRefused& refusal) {
    return refusal.what();
  }
}

bool begins_with(const std::string& path, const std::string& magic) {
  try {
    std::string start(magic.size(), '\0');
    const InputFile file(path, {"file", std::numeric_limits<std::uint64_t>::max()});
    return file.read_at(0, start.data(), start.size()) == magic.size() && start == magic;
  } catch (const InputRefused&) {
    return false;
  }
}

}  // namespace tumblesight::sim
