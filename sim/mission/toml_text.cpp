#include "sim/mission/toml_text.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <string_view>

#include "sim/host/input_file.hpp"
#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint64_t kMostBytes = 1'000'000;
constexpr int kMostOpen = 16;      // lists and inline tables around a value; a mission needs 2
constexpr int kMostKeyParts = 16;  // of a.b.c
constexpr std::size_t kMostOfAFault = 200;

// Counts open brackets and the parts of keys, as far as the text is TOML. Strings and comments do not count.
class Nesting {
 public:
  Nesting(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  void require_shallow() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '#') {
        at_ = text_.find('\n', at_);
        if (at_ == std::string_view::npos) return;
      } else if (c == '"' || c == '\'') {
        skip_string(c);
      } else {
        count(c);
        ++at_;
      }
    }
  }

 private:
  void count(char c) {
    if (c == '\n') ++line_;
    if (c == '.') {
      if (++key_parts_ > kMostKeyParts) refuse("a key has", kMostKeyParts, "parts");
      return;
    }
    if (c == '[' || c == '{') {
      if (++open_ > kMostOpen) refuse("lists and tables are nested", kMostOpen, "deep");
    }
    if ((c == ']' || c == '}') && open_ > 0) --open_;
    const bool is_of_key = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                           c == '-' || c == '_' || c == ' ' || c == '\t';
    if (!is_of_key) key_parts_ = 1;
  }

  // One line between single quotes, or any lines between three; a string of three may end with two more.
  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool is_long = text_.compare(at_, three.size(), three) == 0;
    at_ += is_long ? three.size() : 1;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '\n' && !is_long) return;
      if (c == '\n') ++line_;
      const bool ends = is_long ? text_.compare(at_, three.size(), three) == 0 : c == quote;
      if (ends) break;
      at_ += c == '\\' && quote == '"' ? 2 : 1;
    }
    at_ += is_long ? three.size() : 1;
    for (int more = 0; is_long && more < 2 && at_ < text_.size() && text_[at_] == quote; ++more) ++at_;
  }

  [[noreturn]] void refuse(const char* what, int most, const char* unit) const {
    throw std::invalid_argument(fmt::format("{}, line {}: {} more than {} {}; the file needs no such value",
                                            file_, line_, what, most, unit));
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 1;
  int open_ = 0;
  int key_parts_ = 1;
};

}  // namespace

std::string read_toml(const std::string& path, const char* kind) {
  try {
    return read_text(path, {kind, kMostBytes});
  } catch (const InputRefused& refusal) {
    throw std::invalid_argument(refusal.what());
  }
}

toml::table parse_toml(const std::string& text, const std::string& file) {
  if (text.find('\0') != std::string::npos)
    throw std::invalid_argument(file + ": it is no text, as it has bytes of value 0; is it another file?");
  Nesting(text, file).require_shallow();
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const std::string fault = shortened(std::string(error.description()), kMostOfAFault);
    const bool is_bare = fault.find("could not determine value type") != std::string::npos;
    throw std::invalid_argument(fmt::format("{}, line {}: {}{}", file, error.source().begin.line, fault,
                                            is_bare ? "; a text stands in quotes: name = \"craft\"" : ""));
  }
}

}  // namespace tumblesight::sim
