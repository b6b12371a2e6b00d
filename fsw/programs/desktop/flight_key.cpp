#include "fsw/programs/desktop/flight_key.hpp"

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "hal/dds/idl/development_key.hpp"

namespace tumblesight::hal::dds {
namespace {

constexpr std::size_t kDigits = 2 * std::tuple_size_v<CommandKey>;

int value_of(int digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  const int lower = std::tolower(digit);
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

// True if the file holds just so many digits.
bool read_digits(std::FILE* file, CommandKey& key) {
  std::size_t digits = 0;
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) {
    if (std::isspace(c) != 0) continue;
    const int value = value_of(c);
    if (value < 0 || digits == kDigits) return false;
    std::uint8_t& byte = key[digits / 2];
    byte = static_cast<std::uint8_t>(byte << 4 | value);
    ++digits;
  }
  return digits == kDigits;
}

}  // namespace

bool read_command_key(const char* path, CommandKey& key) {
  if (path[0] == '\0') {
    key = kDevelopmentKey;
    return true;
  }
  std::FILE* const file = std::fopen(path, "r");
  if (file == nullptr) {
    std::fprintf(stderr, "flight: --command-key %s: %s\n", path, strerrordesc_np(errno));
    return false;
  }
  CommandKey read{};
  const bool complete = read_digits(file, read);
  std::fclose(file);
  if (complete) {
    key = read;
  } else {
    std::fprintf(stderr, "flight: --command-key %s: expected %zu hexadecimal digits and nothing else\n", path,
                 kDigits);
  }
  return complete;
}

}  // namespace tumblesight::hal::dds
