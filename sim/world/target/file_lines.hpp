// Text of a mesh file: its lines, words and numbers. All views are into the text, which must outlive them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace tumblesight::sim {

// The lines of a text, whichever way they end: LF, CR LF or CR.
class FileLines {
 public:
  explicit FileLines(std::string_view text) : rest_(text) {}

  // False after the last line.
  bool next(std::string_view& line);
  std::size_t number() const { return number_; }   // of the last line that next() gave, from 1
  std::string_view rest() const { return rest_; }  // after it

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

// The next word, which is removed from `text`; empty at its end. Spaces, tabs, line ends, NUL and Ctrl-Z
// stand between words.
std::string_view next_word(std::string_view& text);
std::string_view without_byte_order_mark(std::string_view text);
std::string_view without_outer_spaces(std::string_view text);
std::string in_lower_case(std::string_view word);

// A number as C writes it, with a dot; "nan" and "inf" with any sign and suffix are numbers, too. Empty if
// the word is something else.
std::optional<double> number_of(std::string_view word);

// "line 12: '1,5' is no number; ...": throws std::runtime_error.
[[noreturn]] void refuse_line(std::size_t number, const std::string& why);
[[noreturn]] void refuse_number(std::size_t number, std::string_view word);

// A word in quotes, short enough for a message.
std::string in_quotes(std::string_view word);

// Whether the first bytes of a file are text: they hold no NUL.
bool looks_like_text(std::string_view bytes);

}  // namespace tumblesight::sim
