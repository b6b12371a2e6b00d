// Table: a table as aligned text for a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tumblesight::sim {

inline constexpr std::size_t kTableWidth = 100;  // columns

// The first column is left-aligned, the others are right-aligned. In a table wider than kTableWidth the
// headings are broken at spaces into two lines.
class Table {
 public:
  explicit Table(std::vector<std::string> header);
  // Missing cells are empty. Throws std::invalid_argument if there are more cells than columns.
  void row(std::vector<std::string> cells);
  void rule();               // a horizontal line below the rows so far
  std::string text() const;  // every line ends in a newline

 private:
  using Widths = std::vector<std::size_t>;

  Widths widths(const std::vector<std::string>& headings) const;
  std::vector<std::string> narrow_headings() const;

  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;  // an empty row is a rule
};

}  // namespace tumblesight::sim
