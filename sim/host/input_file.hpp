// InputFile: a file that a user names, opened for reading. What it is and how large it is are checked before
// any of it is read, so that a pipe does not keep the program waiting and a device does not fill the memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace tumblesight::sim {

// What is expected of a file, for its check and for the messages about it.
struct InputKind {
  const char* name;          // "model image"
  std::uint64_t most_bytes;  // a larger file is refused unread
};

// "model image 'a.tsm' cannot be read: it is a named pipe; write its content to a file first"
class InputRefused : public std::runtime_error {
 public:
  InputRefused(const std::string& message, bool is_missing)
      : std::runtime_error(message), is_missing_(is_missing) {}
  bool is_missing() const { return is_missing_; }  // there is no such file

 private:
  bool is_missing_;
};

class InputFile {
 public:
  // Throws InputRefused, as all functions do, if it cannot be opened, is not a regular file, or is too large.
  // A link to a regular file, also /dev/stdin of a redirected file, counts as one.
  InputFile(const std::string& path, const InputKind& kind);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  std::uint64_t size() const { return size_; }  // bytes when it was opened
  // Fewer than `size` bytes at the end of the file only.
  std::size_t read_at(std::uint64_t offset, void* bytes, std::size_t size) const;
  // The whole content; what was appended since it was opened is left out.
  std::string text() const;
  std::vector<std::uint8_t> bytes() const;
  // The same file, even if its name has become that of another one.
  std::ifstream stream() const;

 private:
  template <class Container>
  Container content() const;
  [[noreturn]] void refuse(const std::string& what, bool is_missing = false) const;

  std::string path_;
  std::string name_;
  int file_ = -1;
  std::uint64_t size_ = 0;
};

std::string read_text(const std::string& path, const InputKind& kind);
std::vector<std::uint8_t> read_bytes(const std::string& path, const InputKind& kind);

// Empty if the file can be opened. Otherwise the message.
std::string fault_of_input(const std::string& path, const InputKind& kind);

// Whether a regular file begins with these bytes. False for everything else.
bool begins_with(const std::string& path, const std::string& magic);

}  // namespace tumblesight::sim
