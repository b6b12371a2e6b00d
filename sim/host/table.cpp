#include "sim/host/table.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

std::string repeated(const std::string& piece, std::size_t times) {
  std::string text;
  for (std::size_t i = 0; i < times; ++i) text += piece;
  return text;
}

std::size_t total(const std::vector<std::size_t>& widths) {
  std::size_t columns = 0;
  for (const std::size_t width : widths) columns += width + 3;
  return columns;
}

std::string rule_line(const std::vector<std::size_t>& widths) {
  return " " + repeated("─", total(widths) - 1) + "\n";
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::size_t widest_line(const std::string& text) {
  std::size_t widest = 0;
  for (const std::string& line : lines_of(text)) widest = std::max(widest, columns_of(line));
  return widest;
}

std::string cells_line(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t column = 0; column < widths.size(); ++column) {
    const std::string padding(widths[column] - columns_of(cells[column]), ' ');
    line += column == 0 ? "  " + cells[column] + padding : "   " + padding + cells[column];
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

// In more columns than given where two lines need them.
std::string in_two_lines(const std::string& heading, std::size_t columns) {
  std::string broken = wrapped(heading, columns);
  while (lines_of(broken).size() > 2) broken = wrapped(heading, ++columns);
  return broken;
}

// Headings of fewer lines than others stand at the bottom.
std::string heading_lines(const std::vector<std::string>& headings, const std::vector<std::size_t>& widths) {
  std::size_t height = 0;
  for (const std::string& heading : headings) height = std::max(height, lines_of(heading).size());
  std::string text;
  for (std::size_t line = 0; line < height; ++line) {
    std::vector<std::string> cells;
    for (const std::string& heading : headings) {
      const std::vector<std::string> own = lines_of(heading);
      const std::size_t above = height - own.size();
      cells.push_back(line < above ? std::string{} : own[line - above]);
    }
    text += cells_line(cells, widths);
  }
  return text;
}

}  // namespace

Table::Table(std::vector<std::string> header) : header_(std::move(header)) {
  if (header_.empty()) throw std::invalid_argument("a table needs at least one column");
}

void Table::row(std::vector<std::string> cells) {
  if (cells.size() > header_.size())
    throw std::invalid_argument("a row with more cells than the table has columns");
  cells.resize(header_.size());
  rows_.push_back(std::move(cells));
}

void Table::rule() {
  rows_.emplace_back();
}

Table::Widths Table::widths(const std::vector<std::string>& headings) const {
  Widths widths(header_.size(), 0);
  const auto widen = [&](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) widths[i] = std::max(widths[i], widest_line(cells[i]));
  };
  widen(headings);
  for (const auto& cells : rows_) widen(cells);
  return widths;
}

std::vector<std::string> Table::narrow_headings() const {
  std::vector<std::string> headings = header_;
  const Widths of_cells = widths(std::vector<std::string>(header_.size()));
  for (std::size_t i = 0; i < headings.size(); ++i) headings[i] = in_two_lines(headings[i], of_cells[i]);
  return headings;
}

std::string Table::text() const {
  std::vector<std::string> headings = header_;
  if (total(widths(headings)) > kTableWidth) headings = narrow_headings();
  const Widths columns = widths(headings);
  std::string text = heading_lines(headings, columns) + rule_line(columns);
  for (const auto& cells : rows_) text += cells.empty() ? rule_line(columns) : cells_line(cells, columns);
  return text;
}

}  // namespace tumblesight::sim
