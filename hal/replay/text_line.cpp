#include "hal/replay/text_line.hpp"

namespace tumblesight::hal::replay {

void TextLine::put(char character) {
  if (size_ + 1 < characters_.size()) characters_[size_++] = character;
}

TextLine& TextLine::text(const char* text) {
  for (; *text != '\0'; ++text) put(*text);
  return *this;
}

TextLine& TextLine::number(std::int64_t value, int width) {
  return decimal(value, 0, width);
}

TextLine& TextLine::decimal(std::int64_t value, int decimals, int width) {
  std::array<char, 24> reversed;
  int size = 0;
  std::uint64_t rest = value < 0 ? 0 - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
  // At least one digit before the point. 64 bits have at most 20 digits.
  for (int digit = 0; digit < 20 && (rest != 0 || digit <= decimals); ++digit) {
    if (digit == decimals && decimals > 0) reversed[size++] = '.';
    reversed[size++] = static_cast<char>('0' + rest % 10);
    rest /= 10;
  }
  if (value < 0) reversed[size++] = '-';
  for (int i = size; i < width; ++i) put(' ');
  while (size > 0) put(reversed[--size]);
  return *this;
}

TextLine& TextLine::hexadecimal(std::uint32_t value) {
  for (int shift = 28; shift >= 0; shift -= 4) put("0123456789abcdef"[(value >> shift) & 15]);
  return *this;
}

}  // namespace tumblesight::hal::replay
