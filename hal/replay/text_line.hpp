// TextLine: composes one line of text without printf. Text beyond 119 characters is cut off.
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
  // value / 10^decimals, right-aligned in at least `width` characters.
  TextLine& decimal(std::int64_t value, int decimals, int width = 0);
  TextLine& hexadecimal(std::uint32_t value);  // eight digits
  const char* c_str() const { return characters_.data(); }

 private:
  void put(char character);

  std::array<char, 120> characters_{};  // NUL-terminated
  std::size_t size_ = 0;
};

}  // namespace tumblesight::hal::replay
