#include "sim/report/data_table.hpp"

#include <fmt/format.h>

#include "sim/host/table.hpp"
#include "sim/report/svg.hpp"

namespace tumblesight::sim {
namespace {

constexpr const char* kIndent = "  ";

bool is_title(const DataTable& table, const std::vector<TableCell>& row) {
  return row.size() == 1 && table.header.size() > 1;
}

std::string markdown_line(const std::vector<TableCell>& cells) {
  std::string line = "|";
  for (const TableCell& cell : cells) {
    const bool strong = cell.mark == Mark::kRcnn || cell.mark == Mark::kMissed;
    std::string text;
    for (const char c : cell.text) text += c == '|' ? std::string("\\|") : std::string(1, c);
    line += strong && !text.empty() ? " **" + text + "** |" : " " + text + " |";
  }
  return line + "\n";
}

std::string html_cell(const TableCell& cell) {
  if (cell.text == "-") return "<span class=quiet>–</span>";
  const std::string text = escape_markup(cell.text);
  switch (cell.mark) {
    case Mark::kRcnn:
      return "<b class=rcnn>" + text + "</b>";
    case Mark::kCnn:
      return "<b class=cnn>" + text + "</b>";
    case Mark::kPaper:
      return "<span class=paper>" + text + "</span>";
    case Mark::kMet:
      return "<span class=met>" + text + "</span>";
    case Mark::kMissed:
      return "<span class=missed>" + text + "</span>";
    case Mark::kNone:
      break;
  }
  return text;
}

std::string html_row(const std::vector<std::string>& cells, const char* tag) {
  std::string html = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    html += fmt::format("<{0}{1}>{2}</{0}>", tag, i == 0 ? "" : " class=number", cells[i]);
  }
  return html + "</tr>\n";
}

}  // namespace

DataTable transposed(const DataTable& table) {
  if (table.rows.empty()) return table;
  DataTable turned{{table.header.front()}, {}};
  for (const std::vector<TableCell>& row : table.rows) turned.header.push_back(row.front().text);
  for (std::size_t column = 1; column < table.header.size(); ++column) {
    std::vector<TableCell> cells{{table.header[column]}};
    for (const std::vector<TableCell>& row : table.rows) cells.push_back(row[column]);
    turned.rows.push_back(cells);
  }
  return turned;
}

std::string terminal_text(const DataTable& table) {
  if (table.rows.empty()) return {};
  Table text(table.header);
  bool titled = false;
  for (const std::vector<TableCell>& row : table.rows) {
    const bool title = is_title(table, row);
    if (title && titled) text.rule();
    titled = titled || title;
    std::vector<std::string> cells;
    for (const TableCell& cell : row) cells.push_back(cell.text);
    const bool indented = !title && (titled || row.front().mark == Mark::kPaper);
    if (indented) cells.front() = kIndent + cells.front();
    text.row(cells);
  }
  return text.text();
}

std::string markdown_text(const DataTable& table) {
  if (table.rows.empty()) return {};
  std::vector<TableCell> header;
  for (const std::string& heading : table.header) header.push_back({heading});
  std::string text = markdown_line(header) + "|---|";
  for (std::size_t i = 1; i < header.size(); ++i) text += "---:|";
  text += "\n";
  for (std::vector<TableCell> row : table.rows) {
    row.resize(table.header.size());
    text += markdown_line(row);
  }
  return text + "\n";
}

std::string html_text(const DataTable& table, const std::string& css_class) {
  if (table.rows.empty()) return {};
  std::vector<std::string> header;
  for (const std::string& heading : table.header) header.push_back(escape_markup(heading));
  std::string html =
      fmt::format("<table class=\"{}\"><thead>\n{}</thead><tbody>\n", css_class, html_row(header, "th"));
  for (const std::vector<TableCell>& row : table.rows) {
    if (is_title(table, row)) {
      html +=
          fmt::format("<tr class=group><th colspan={}>{}</th></tr>\n", header.size(), html_cell(row.front()));
      continue;
    }
    std::vector<std::string> cells;
    for (const TableCell& cell : row) cells.push_back(html_cell(cell));
    html += html_row(cells, "td");
  }
  return html + "</tbody></table>\n";
}

}  // namespace tumblesight::sim
