// TextLine: one line of text, put together without printf. What does not fit is cut off.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tumblesight::hal::replay {

class TextLine {
 public:
  TextLine& text(const char* text);
  // Right-aligned in at least `width` characters.
  TextLine& number(std::int64_t value, int width = 0);
  // value / 10^decimals.
  TextLine& decimal(std::int64_t value, int decimals, int width = 0);
  TextLine& hexadecimal(std::uint32_t value);  // eight digits
  const char* c_str() const { return characters_.data(); }

 private:
  void put(char character);

  std::array<char, 120> characters_{};  // the last one stays NUL
  std::size_t size_ = 0;
};

}  // namespace tumblesight::hal::replay
