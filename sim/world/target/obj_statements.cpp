#include "sim/world/target/obj_statements.hpp"

#include <algorithm>
#include <iterator>

namespace tumblesight::sim {
namespace {

constexpr std::string_view kKeywords[] = {"v",      "vt",   "vn",    "vp",   "f",      "fo",
                                          "l",      "p",    "g",     "o",    "s",      "usemtl",
                                          "mtllib", "curv", "curv2", "surf", "cstype", "end"};

bool is_keyword(std::string_view word) {
  return std::find(std::begin(kKeywords), std::end(kKeywords), word) != std::end(kKeywords);
}

// Names may hold a '#'.
bool is_named(std::string_view line) {
  const std::string_view keyword = next_word(line);
  return keyword == "usemtl" || keyword == "mtllib" || keyword == "g" || keyword == "o";
}

// Whether a line begins a statement of its own: its keyword, and a number where one must follow.
bool begins_statement(std::string_view line) {
  const std::string_view keyword = next_word(line), first = next_word(line);
  if (!is_keyword(keyword) || first.empty()) return false;
  const bool is_of_numbers = keyword[0] == 'v' || keyword == "f" || keyword == "l" || keyword == "p";
  return !is_of_numbers || number_of(first.substr(0, first.find('/'))).has_value();
}

// 1.#IND, 1.#INF, 1.#QNAN, 1.#SNAN
bool is_in_number(std::string_view line, std::size_t at) {
  if (at == 0 || line[at - 1] != '.') return false;
  for (const std::string_view mark : {"IND", "INF", "QNAN", "SNAN"}) {
    if (line.substr(at + 1, mark.size()) == mark) return true;
  }
  return false;
}

std::string_view without_end_spaces(std::string_view line) {
  while (!line.empty() && (line.back() == ' ' || line.back() == '\t')) line.remove_suffix(1);
  return line;
}

std::string_view without_comment(std::string_view line) {
  for (std::size_t at = line.find('#'); at != std::string_view::npos; at = line.find('#', at + 1)) {
    if (!is_in_number(line, at) && !is_named(line.substr(0, at))) return line.substr(0, at);
  }
  return without_end_spaces(line);
}

bool ends_in_backslash(std::string_view statement) {
  return !statement.empty() && statement.back() == '\\';
}

// "12" -> "", "12/3/4" -> "0/0/": which of a corner's numbers are given, beside the first.
std::string form_of(std::string_view corner) {
  std::string form;
  for (const char c : corner.substr(std::min(corner.find('/'), corner.size()))) {
    if (c == '/') form += c;
    if (c != '/' && form.back() == '/') form += '0';
  }
  return form;
}

bool is_whole_face(std::string_view words) {
  std::size_t corners = 0;
  std::string form;
  for (std::string_view word = next_word(words); !word.empty(); word = next_word(words)) {
    if (corners++ == 0) form = form_of(word);
    if (form_of(word) != form) return false;
  }
  return corners >= 3;
}

}  // namespace

bool ObjStatements::next(std::string_view& keyword, std::string_view& words) {
  std::string_view line;
  if (!lines_.next(line)) return false;
  number_ = lines_.number();
  std::string_view statement = without_comment(line);
  if (is_continued(statement)) {
    joined_.clear();
    while (is_continued(statement)) {
      joined_.append(statement.substr(0, statement.size() - 1)) += ' ';
      if (!lines_.next(line)) {
        statement = {};
        joined_ += '\\';  // nothing follows: the statement is not whole
        break;
      }
      statement = without_comment(line);
    }
    joined_.append(statement);
    statement = joined_;
  }
  keyword = next_word(statement);
  words = statement;
  return true;
}

// In "g C:\parts\" the backslash belongs to the name if the next line is a statement without it.
bool ObjStatements::is_continued(std::string_view statement) const {
  if (!ends_in_backslash(statement)) return false;
  if (!is_named(statement)) return true;
  FileLines following(lines_.rest());
  std::string_view line;
  return following.next(line) && !begins_statement(line);
}

bool is_whole_statement(std::string_view keyword, std::string_view words) {
  if (ends_in_backslash(words) && !is_named(keyword)) return false;
  if (keyword == "f" || keyword == "fo") return is_whole_face(words);
  const std::size_t least = keyword == "v" || keyword == "vn"   ? 3
                            : keyword == "vt" || keyword == "l" ? 1
                            : keyword == "p"                    ? 1
                                                                : 0;
  std::size_t count = 0;
  while (!next_word(words).empty()) ++count;
  if (count < least) return false;
  const auto begins = [keyword](std::string_view known) {
    return keyword.size() < known.size() && known.substr(0, keyword.size()) == keyword;
  };
  return keyword.empty() || is_keyword(keyword) ||
         std::none_of(std::begin(kKeywords), std::end(kKeywords), begins);
}

}  // namespace tumblesight::sim
