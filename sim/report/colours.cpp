#include "sim/report/colours.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace tumblesight::sim {

// One colour per condition in the order of the table of conditions, and spare ones for conditions to come.
const char* colour_of(Condition condition) {
  static constexpr const char* kColours[] = {kRcnnColour, "#3fa0a8", "#b83227", "#3a8a3f", "#7a4fa0",
                                             "#b58a1b",   "#5a6069", "#c25b8f", "#8a6d3b", "#4c7a9b"};
  return kColours[static_cast<std::size_t>(condition) % std::size(kColours)];
}

namespace {

// Seven equidistant stops, CIE lightness 22, 33, 45, 58, 70, 82, 93.
constexpr std::array<std::array<double, 3>, 7> kStops{{{31, 46, 92},
                                                       {28, 77, 124},
                                                       {19, 109, 139},
                                                       {44, 144, 142},
                                                       {104, 178, 133},
                                                       {181, 207, 124},
                                                       {250, 231, 148}}};

}  // namespace

Rgb sequential_colour(double value) {
  const double position = std::clamp(value, 0.0, 1.0) * static_cast<double>(kStops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(position), kStops.size() - 2);
  const double part = position - static_cast<double>(below);
  Rgb colour{};
  for (std::size_t channel = 0; channel < colour.size(); ++channel) {
    const double mixed = (1.0 - part) * kStops[below][channel] + part * kStops[below + 1][channel];
    colour[channel] = static_cast<std::uint8_t>(std::lround(mixed));
  }
  return colour;
}

}  // namespace tumblesight::sim
