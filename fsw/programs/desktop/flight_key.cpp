#include "fsw/programs/desktop/flight_key.hpp"

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "fsw/programs/desktop/flight_program.hpp"
#include "hal/dds/idl/development_key.hpp"

namespace tumblesight::fsw::desktop {
namespace {

constexpr std::size_t kDigits = 2 * std::tuple_size_v<hal::CommandKey>;

// -1 if it is not a hexadecimal digit.
int hex_value(int digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  const int lower = std::tolower(digit);
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

// Returns whether the file holds exactly kDigits digits.
bool read_digits(std::FILE* file, hal::CommandKey& key) {
  std::size_t digits = 0;
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) {
    if (std::isspace(c) != 0) continue;
    const int value = hex_value(c);
    if (value < 0 || digits == kDigits) return false;
    std::uint8_t& byte = key[digits / 2];
    byte = static_cast<std::uint8_t>(byte << 4 | value);
    ++digits;
  }
  return digits == kDigits;
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
  std::FILE* const file = std::fopen(path, "r");
  if (file == nullptr) {
    std::fprintf(stderr, "%s: --command-key %s: %s\n", kProgramName, path, strerrordesc_np(errno));
    return false;
  }
  hal::CommandKey read{};
  const bool complete = read_digits(file, read);
  std::fclose(file);
  if (complete) {
    key = read;
  } else {
    std::fprintf(stderr, "%s: --command-key %s: expected %zu hexadecimal digits and nothing else\n",
                 kProgramName, path, kDigits);
  }
  return complete;
}

}  // namespace tumblesight::fsw::desktop
