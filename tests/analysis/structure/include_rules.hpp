// Who may know whom, as rules on include lines.
#pragma once

#include <string>
#include <vector>

namespace tumblesight::structure {

struct Include {
  int line = 0;
  std::string path;
  bool quoted = false;
};

// The include lines of a source text, those behind // left out.
std::vector<Include> includes_of(const std::string& text);

// Why the file (path from the root, '/' between folders) may not have this include; empty if it may.
std::string objection(const std::string& file, const Include& include);

}  // namespace tumblesight::structure
