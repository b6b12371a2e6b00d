#include "sim/terminal/local_time.hpp"

#include <fmt/chrono.h>

#include <ctime>

namespace tumblesight::sim {

std::string local_time_text() {
  return fmt::format("{:%Y-%m-%d %H:%M %Z}", fmt::localtime(std::time(nullptr)));
}

}  // namespace tumblesight::sim
