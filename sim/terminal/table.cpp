#include "sim/terminal/table.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

namespace tumblesight::sim {
namespace {

std::size_t columns_of(const std::string& utf8) {
  return static_cast<std::size_t>(std::count_if(
      utf8.begin(), utf8.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string repeated(const std::string& piece, std::size_t times) {
  std::string text;
  for (std::size_t i = 0; i < times; ++i) text += piece;
  return text;
}

std::string rule_line(const std::vector<std::size_t>& widths) {
  std::size_t total = 0;
  for (const std::size_t width : widths) total += width + 3;
  return " " + repeated("─", total - 1) + "\n";
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

std::string Table::text() const {
  std::vector<std::size_t> widths(header_.size(), 0);
  const auto widen = [&](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) widths[i] = std::max(widths[i], columns_of(cells[i]));
  };
  widen(header_);
  for (const auto& cells : rows_) widen(cells);

  std::string text = cells_line(header_, widths) + rule_line(widths);
  for (const auto& cells : rows_) text += cells.empty() ? rule_line(widths) : cells_line(cells, widths);
  return text;
}

}  // namespace tumblesight::sim
