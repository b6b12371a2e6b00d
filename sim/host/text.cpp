#include "sim/host/text.hpp"

#include <fmt/chrono.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <ctime>
#include <sstream>

namespace tumblesight::sim {

// One per character: the bytes that do not continue one.
std::size_t columns_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

void print_message(const std::string& line) {
  std::fputs((line + "\n").c_str(), stderr);
}

void print_note(const std::string& text) {
  print_message("  note: " + text);
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

namespace {

bool continues_a_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

// Bytes of the character that begins at `at`; 0 if none does.
std::size_t size_of_character(const std::string& text, std::size_t at) {
  const auto first = static_cast<unsigned char>(text[at]);
  if (first < 0x80U) return 1;
  const std::size_t size = first >= 0xF5U   ? 0
                           : first >= 0xF0U ? 4
                           : first >= 0xE0U ? 3
                           : first >= 0xC2U ? 2
                                            : 0;
  if (at + size > text.size()) return 0;
  for (std::size_t i = 1; i < size; ++i) {
    if (!continues_a_character(text[at + i])) return 0;
  }
  // The second byte tells longer forms of shorter characters, halves of pairs, and what is beyond the last
  // one.
  const auto second = static_cast<unsigned char>(size > 1 ? text[at + 1] : '\0');
  const bool is_character = !(first == 0xE0U && second < 0xA0U) && !(first == 0xEDU && second > 0x9FU) &&
                            !(first == 0xF0U && second < 0x90U) && !(first == 0xF4U && second > 0x8FU);
  return is_character ? size : 0;
}

}  // namespace

std::string shortened(const std::string& text, std::size_t most) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = size_of_character(text, at), step = std::max<std::size_t>(1, size);
    if (at + step > most) return result + "...";
    const bool shown = size > 0 && std::iscntrl(static_cast<unsigned char>(text[at])) == 0;
    result += shown ? text.substr(at, size) : "?";
    at += step;
  }
  return result;
}

bool is_utf8(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = size_of_character(text, at);
    if (size == 0) return false;
    at += size;
  }
  return true;
}

std::string local_time_text() {
  return fmt::format("{:%Y-%m-%d %H:%M %Z}", fmt::localtime(std::time(nullptr)));
}

std::string shell_word(const std::string& word) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::vector<std::string> shell_words(const std::string& line) {
  std::vector<std::string> words;
  bool in_word = false;
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    char c = line[i];
    const bool is_space = c == ' ' || c == '\t' || c == '\n';
    if (quote == 0 && is_space) {
      in_word = false;
      continue;
    }
    if (!in_word) words.emplace_back();
    in_word = true;
    if (c == quote) {
      quote = 0;
    } else if (quote == 0 && (c == '\'' || c == '"')) {
      quote = c;
    } else {
      if (c == '\\' && quote != '\'' && i + 1 < line.size()) c = line[++i];
      words.back() += c;
    }
  }
  return words;
}

}  // namespace tumblesight::sim
