#include "sim/world/target/file_lines.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>
#include <stdexcept>

#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::string_view kBetweenWords(" \t\r\n\v\f\0\x1a", 8);
constexpr std::size_t kLookedAt = 1024;  // bytes, to tell text from others

// What other programs write for numbers that are none: nan, -nan(ind), inf, 1.#QNAN, -1.#INF.
std::optional<double> not_finite_of(std::string_view word) {
  const std::string lower = in_lower_case(word);
  if (lower.find("nan") != std::string::npos || lower.find("#ind") != std::string::npos)
    return std::numeric_limits<double>::quiet_NaN();
  if (lower.find("inf") == std::string::npos) return std::nullopt;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return lower.front() == '-' ? -kInfinity : kInfinity;
}

}  // namespace

bool FileLines::next(std::string_view& line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find_first_of("\r\n");
  line = rest_.substr(0, end);
  ++number_;
  if (end == std::string_view::npos) {
    rest_ = {};
    return true;
  }
  const bool is_pair = rest_[end] == '\r' && end + 1 < rest_.size() && rest_[end + 1] == '\n';
  rest_.remove_prefix(end + (is_pair ? 2 : 1));
  return true;
}

std::string_view next_word(std::string_view& text) {
  const std::size_t first = text.find_first_not_of(kBetweenWords);
  if (first == std::string_view::npos) {
    text = {};
    return {};
  }
  const std::size_t end = std::min(text.find_first_of(kBetweenWords, first), text.size());
  const std::string_view word = text.substr(first, end - first);
  text.remove_prefix(end);
  return word;
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.substr(0, kMark.size()) == kMark ? text.substr(kMark.size()) : text;
}

std::string_view without_outer_spaces(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBetweenWords);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBetweenWords) - first + 1);
}

std::string in_lower_case(std::string_view word) {
  std::string lower(word);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

std::optional<double> number_of(std::string_view word) {
  const std::string_view unsigned_word = !word.empty() && word.front() == '+' ? word.substr(1) : word;
  double value = 0.0;
  const char* const end = unsigned_word.data() + unsigned_word.size();
  const auto [stop, error] = std::from_chars(unsigned_word.data(), end, value);
  if (stop == end && error == std::errc()) return value;
  if (stop == end && error == std::errc::result_out_of_range) {
    // 1e-400 counts as 0, 1e400 as infinite.
    const std::size_t exponent = in_lower_case(unsigned_word).find("e-");
    return exponent != std::string::npos ? 0.0 : std::numeric_limits<double>::infinity();
  }
  return word.empty() ? std::nullopt : not_finite_of(word);
}

void refuse_line(std::size_t number, const std::string& why) {
  throw std::runtime_error("line " + std::to_string(number) + ": " + why);
}

void refuse_number(std::size_t number, std::string_view word) {
  if (word.empty()) refuse_line(number, "ends before its numbers do; export the mesh again");
  const bool comma = word.find(',') != std::string_view::npos;
  refuse_line(number,
              in_quotes(word) + " is no number; " +
                  (comma ? "export the mesh with a decimal point, not a comma" : "export the mesh again"));
}

std::string in_quotes(std::string_view word) {
  return "'" + shortened(std::string(word.substr(0, 4 * kMostOfAValue))) + "'";
}

bool looks_like_text(std::string_view bytes) {
  return bytes.substr(0, kLookedAt).find('\0') == std::string_view::npos;
}

}  // namespace tumblesight::sim
