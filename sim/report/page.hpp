// Page: the frame of every HTML report: one self-contained file, no scripts, nothing loaded. And the pieces
// that reports share.
#pragma once

#include <string>
#include <vector>

namespace tumblesight::sim {

// `body`: markup. The title is escaped.
std::string html_page(const std::string& title, const std::string& body);
// Heading and caption are markup; nothing at all when `svg` is empty.
std::string html_figure(const std::string& heading, const std::string& svg, const std::string& caption);

// Cells are markup; those after the first `text_columns` are set as numbers, to the right.
struct HtmlTable {
  std::string css_class;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  // a row of one cell is a heading over the rows below it
  std::size_t text_columns = 1;
};
std::string html_table(const HtmlTable& table);

}  // namespace tumblesight::sim
