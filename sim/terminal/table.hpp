// Table: a table as aligned text for a terminal.
#pragma once

#include <string>
#include <vector>

namespace tumblesight::sim {

// The first column is left-aligned, the others are right-aligned. Text is UTF-8; every code point counts as
// one column.
class Table {
 public:
  explicit Table(std::vector<std::string> header);
  // Missing cells are empty. Throws std::invalid_argument if there are more cells than columns.
  void row(std::vector<std::string> cells);
  void rule();               // a horizontal line below the rows so far
  std::string text() const;  // every line ends in a newline

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;  // an empty row is a rule
};

}  // namespace tumblesight::sim
