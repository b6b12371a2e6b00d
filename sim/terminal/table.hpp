// Table: aligned text for a terminal.
#pragma once

#include <string>
#include <vector>

namespace tumblesight::sim {

// First column left-aligned, the others right-aligned. Cells may hold UTF-8; a code point counts as one
// column.
class Table {
 public:
  explicit Table(std::vector<std::string> header);
  void row(std::vector<std::string> cells);  // missing cells are empty, surplus ones an std::invalid_argument
  void rule();                               // a line between the rows before and after
  std::string text() const;                  // every line ends in a newline

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;  // an empty row is a rule
};

}  // namespace tumblesight::sim
