// The files of the page: those of sim/console/page/, which the program contains, and the two libraries, which
// are read from where Debian installs them.
#pragma once

#include <string>
#include <string_view>

namespace tumblesight::sim {

struct PageFile {
  const char* type;  // of its content, as HTTP names it
  std::string_view content;
};

// `path`: "/" or "/console.css". Null: there is no such file.
const PageFile* page_file(const std::string& path);

// Empty, or which library of the page is missing and how to install it.
std::string missing_libraries();

}  // namespace tumblesight::sim
