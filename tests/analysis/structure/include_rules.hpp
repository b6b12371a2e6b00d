// The rules on include lines: which folder may include which ("Who may know whom", docs/architecture.md), and
// no two folders include each other.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace tumblesight::structure {

struct Include {
  int line = 0;
  std::string path;
  bool quoted = false;
};

// The include lines of a source text. Lines commented out with // do not count.
std::vector<Include> includes_of(const std::string& text);

// The reason why the file (path from the root, '/' between folders) may not have this include; empty if it
// may.
std::string objection(const std::string& file, const Include& include);

// Includes across folders, counted per folder: each folder is a node, files directly in it are its members.
class FolderGraph {
 public:
  // Includes within a folder, of other libraries and of generated files outside the tree do not count.
  void add(const std::string& file, const Include& include);

  // Each pair of folders that include each other, once, with one example in each direction:
  // "gnc/a <-> gnc/b: gnc/a/x.cpp includes gnc/b/y.hpp; gnc/b/z.hpp includes gnc/a/x.hpp".
  std::vector<std::string> mutual_pairs() const;

 private:
  std::map<std::pair<std::string, std::string>, std::string> edges_;  // (from, to) -> the first example
};

}  // namespace tumblesight::structure
