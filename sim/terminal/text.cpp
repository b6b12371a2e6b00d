#include "sim/terminal/text.hpp"

#include <fmt/chrono.h>

#include <algorithm>
#include <ctime>
#include <sstream>

namespace tumblesight::sim {

// One per character: the bytes that do not continue one.
std::size_t columns_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string wrapped(const std::string& text, std::size_t columns) {
  std::string result;
  std::size_t used = 0;  // columns of the last line
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::size_t width = columns_of(word);
    const bool fits = used + 1 + width <= columns;
    if (used > 0) result += fits ? ' ' : '\n';
    used = used > 0 && fits ? used + 1 + width : width;
    result += word;
  }
  return result;
}

std::string local_time_text() {
  return fmt::format("{:%Y-%m-%d %H:%M %Z}", fmt::localtime(std::time(nullptr)));
}

}  // namespace tumblesight::sim
