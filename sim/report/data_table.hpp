// DataTable: a table of results as data, and the three ways to write it: aligned text for a terminal,
// Markdown, HTML.
#pragma once

#include <string>
#include <vector>

namespace tumblesight::sim {

// The meaning of a cell; each writer decides how to show it.
enum class Mark {
  kNone,
  kRcnn,  // our main figure
  kCnn,
  kPaper,   // a published figure, below ours
  kMet,     // a goal or a limit that is met
  kMissed,  // a goal or a limit that is missed
};

struct TableCell {
  std::string text;  // plain text, the writers escape it; "-": there is no such figure
  Mark mark = Mark::kNone;
};

// Every row has as many cells as the header, or one cell: then it is the title of the rows below it.
struct DataTable {
  std::vector<std::string> header;
  std::vector<std::vector<TableCell>> rows;
};

// A column per row and a row per column, for a table without titles. A table without rows stays as it is.
DataTable transposed(const DataTable& table);

// The first column is left-aligned, the others are right-aligned. A table without rows gives an empty text.
std::string terminal_text(const DataTable& table);
std::string markdown_text(const DataTable& table);  // ends in an empty line
std::string html_text(const DataTable& table, const std::string& css_class);

}  // namespace tumblesight::sim
