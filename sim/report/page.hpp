// The frame of every HTML page: one self-contained file, no scripts, nothing loaded.
#pragma once

#include <string>

namespace tumblesight::sim {

// `body` is markup; the title is plain text.
std::string html_page(const std::string& title, const std::string& body);
// A figure below its heading. Heading and caption are markup. Empty when `svg` is empty.
std::string html_figure(const std::string& heading, const std::string& svg, const std::string& caption);

}  // namespace tumblesight::sim
