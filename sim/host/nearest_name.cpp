#include "sim/host/nearest_name.hpp"

#include <algorithm>
#include <cstddef>

namespace tumblesight::sim {
namespace {

constexpr std::size_t kLongest = 64;  // no name is longer, and the time grows with the square

// Changes that make one text of the other.
std::size_t changes_between(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = a[i - 1] == b[j - 1];
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

}  // namespace

std::string nearest_name(const std::string& wrong, const std::vector<std::string>& known) {
  if (wrong.size() > kLongest) return {};
  std::string nearest;
  std::size_t fewest = wrong.size() / 3 + 1;  // that many are too many
  if (wrong.size() < 3) fewest = 0;           // everything short is near
  for (const std::string& name : known) {
    if (name.size() > kLongest) continue;
    const std::size_t changes = changes_between(wrong, name);
    if (changes == 0 || changes >= fewest) continue;
    fewest = changes;
    nearest = name;
  }
  return nearest;
}

std::string did_you_mean(const std::string& wrong, const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(wrong, known);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

}  // namespace tumblesight::sim
