#include "fsw/programs/desktop/flight_key.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "fsw/programs/desktop/flight_program.hpp"
#include "hal/dds/idl/development_key.hpp"

namespace tumblesight::fsw::desktop {
namespace {

constexpr int kLongestWait_ms = 2000;  // for the writer of a pipe
constexpr off_t kMostBytes = 4096;     // of a key's file: digits, and spaces between them
constexpr std::size_t kDigits = 2 * std::tuple_size_v<hal::CommandKey>;

// -1 if it is not a hexadecimal digit.
int hex_value(int digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  const int lower = std::tolower(digit);
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

// A pipe gives its content once, as the shell's <(command) does.
bool is_written(int pipe) {
  pollfd waiting{pipe, POLLIN, 0};
  return poll(&waiting, 1, kLongestWait_ms) > 0;
}

// 1: `byte` is the next one; 0: the file has ended; -1: it cannot be read.
ssize_t read_byte(int file, unsigned char& byte) {
  ssize_t count = 0;
  do {
    count = read(file, &byte, 1);
  } while (count < 0 && (errno == EINTR || (errno == EAGAIN && is_written(file))));
  return count;
}

// Returns whether the file holds exactly kDigits digits. Not by stdio, which would use the heap.
bool read_digits(int file, hal::CommandKey& key) {
  std::size_t digits = 0;
  for (off_t i = 0; i <= kMostBytes; ++i) {
    unsigned char byte = 0;
    const ssize_t count = read_byte(file, byte);
    if (count <= 0) return count == 0 && digits == kDigits;
    if (std::isspace(byte) != 0) continue;
    const int value = hex_value(byte);
    if (value < 0 || digits == kDigits) return false;
    std::uint8_t& target = key[digits / 2];
    target = static_cast<std::uint8_t>(target << 4 | value);
    ++digits;
  }
  return false;
}

// -1, with the reason, if it is neither a regular file nor a pipe that somebody writes.
int opened(const char* path, const char*& reason) {
  const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat found {};
  if (file < 0 || fstat(file, &found) != 0) {
    reason = strerrordesc_np(errno);
  } else if (!S_ISREG(found.st_mode) && !S_ISFIFO(found.st_mode)) {
    reason = "it is not a regular file; give a file";
  } else if (S_ISFIFO(found.st_mode) && !is_written(file)) {
    reason = "nobody has written to this pipe within 2 s; give a file, or start its writer first";
  } else if (found.st_size > kMostBytes) {
    reason = "it has more than 4096 bytes, and a key has 64 hexadecimal digits: is it another file?";
  } else {
    return file;
  }
  if (file >= 0) (void)close(file);
  return -1;
}

}  // namespace

bool read_command_key(const char* path, hal::CommandKey& key) {
  if (path[0] == '\0') {
    key = hal::dds::kDevelopmentKey;
    std::fprintf(stderr,
                 "%s: note: telecommands are signed with the public development key; anyone can command; "
                 "give --command-key\n",
                 kProgramName);
    return true;
  }
  const char* reason = "";
  const int file = opened(path, reason);
  if (file < 0) {
    std::fprintf(stderr, "%s: --command-key %s: %s\n", kProgramName, path, reason);
    return false;
  }
  hal::CommandKey read{};
  const bool complete = read_digits(file, read);
  (void)close(file);
  if (complete) {
    key = read;
  } else {
    std::fprintf(stderr, "%s: --command-key %s: expected %zu hexadecimal digits and nothing else\n",
                 kProgramName, path, kDigits);
  }
  return complete;
}

}  // namespace tumblesight::fsw::desktop
