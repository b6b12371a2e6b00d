#include "sim/cli/disturbance_arguments.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>

#include "sim/cli/arguments.hpp"

namespace tumblesight::sim {
namespace {

constexpr const char* kGroup = "Disturbances";

void add_flag(Command& command, const DisturbanceRow& row, Disturbances& disturbances) {
  command
      .add_flag_function(
          std::string("--") + row.name,
          [&row, &disturbances](bool on) { row.set(disturbances, on ? 1.0 : 0.0); }, row.explanation)
      ->group(kGroup);
}

void add_value(Command& command, const DisturbanceRow& row, Disturbances& disturbances) {
  const bool whole = row.kind == DisturbanceKind::kWholeNumber;
  CommandOption option = command.add_option_function<std::string>(
      std::string("--") + row.name,
      [&row, &disturbances](const std::string& text) {
        row.set(disturbances, std::strtod(text.c_str(), nullptr));
      },
      row.explanation);
  if (whole) {
    limit_whole_number(option, static_cast<std::uint64_t>(row.lowest),
                       static_cast<std::uint64_t>(row.highest));
  } else {
    limit_number(option, row.lowest, row.highest);
  }
  option->type_name(row.type_name)->group(kGroup);
  // A default outside the limits means that the disturbance is off.
  const double value = row.get(disturbances);
  if (value >= row.lowest && value != 0.0) option->default_str(fmt::format("{:g}", value));
}

}  // namespace

void add_disturbance_options(Command& command, Disturbances& disturbances) {
  for (const DisturbanceRow& row : kDisturbances) {
    row.kind == DisturbanceKind::kFlag ? add_flag(command, row, disturbances)
                                       : add_value(command, row, disturbances);
  }
}

std::string disturbance_examples(const std::string& verb) {
  return fmt::format(
      "\nDisturbances keep attitude, rate, range and noise of every sequence: a run with\n"
      "one and a run without it show the same sequences. Several may be combined. A\n"
      "frame that is both lost and frozen is lost. If the image that a frozen sensor\n"
      "repeats was lost, it arrives late, and only the next one is a repeat.\n\n"
      "Example: the sensor repeats an image three times, then works for two frames\n"
      "  tumblesight {0} --frozen 3 --well-frames 2\n\n"
      "Example: a chaser that turns at 5 deg/s, with and without its attitude as input\n"
      "  tumblesight {0} --chaser-rate 5\n"
      "  tumblesight {0} --chaser-rate 5 --no-ego-motion\n",
      verb);
}

void require_possible_disturbances(const Disturbances& disturbances, std::uint32_t frames) {
  try {
    require_possible(disturbances, frames);
  } catch (const std::invalid_argument& error) {
    throw ArgumentFault(error.what());
  }
}

}  // namespace tumblesight::sim
