// The statements of an OBJ file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "sim/world/target/file_lines.hpp"

namespace tumblesight::sim {

// Lines that a backslash joins, without their comments. A comment ends with its line, whatever is at its end.
class ObjStatements {
 public:
  explicit ObjStatements(std::string_view text) : lines_(text) {}

  // False at the end. `words`: of the statement without its keyword; valid until the next call.
  bool next(std::string_view& keyword, std::string_view& words);
  std::size_t number() const { return number_; }  // of the statement's first line
  bool is_last() const { return lines_.rest().empty(); }

 private:
  bool is_continued(std::string_view statement) const;

  FileLines lines_;
  std::string joined_;
  std::size_t number_ = 0;
};

// Whether a statement has all that it must have. A cut within one can leave the beginning of its keyword, too
// few numbers, or a last corner of another form than the first: "f 1/1 2/2 3".
bool is_whole_statement(std::string_view keyword, std::string_view words);

}  // namespace tumblesight::sim
