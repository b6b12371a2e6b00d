#include "sim/report/palette.hpp"

#include <cstddef>
#include <iterator>

namespace tumblesight::sim {

// One colour per condition in the order of the table of conditions, and spare ones for conditions to come.
const char* colour_of(Condition condition) {
  static constexpr const char* kColours[] = {kRcnnColour, "#3fa0a8", "#b83227", "#3a8a3f", "#7a4fa0",
                                             "#b58a1b",   "#5a6069", "#c25b8f", "#8a6d3b", "#4c7a9b"};
  return kColours[static_cast<std::size_t>(condition) % std::size(kColours)];
}

}  // namespace tumblesight::sim
