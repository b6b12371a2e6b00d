// Text files: reports, tables, figures.
#pragma once

#include <string>

namespace tumblesight::sim {

// Creates missing folders. Throws std::runtime_error that names the file and the reason.
void write_text_file(const std::string& path, const std::string& content);

}  // namespace tumblesight::sim
