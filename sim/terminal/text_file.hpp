// Writing of text files: reports, tables, figures.
#pragma once

#include <string>

namespace tumblesight::sim {

// Replaces the file as a whole: a reader never finds a part of it. Creates missing folders. Throws
// std::runtime_error that names the file and the reason.
void write_text_file(const std::string& path, const std::string& content);

}  // namespace tumblesight::sim
