#include "sim/cli/symmetry_arguments.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace tumblesight::sim {

void add_symmetry_option(Command& command, TargetSymmetry& symmetry) {
  command
      .add_option_function<std::vector<std::string>>(
          "--symmetry",
          [&symmetry](const std::vector<std::string>& texts) {
            try {
              symmetry = target_symmetry_from(texts);
            } catch (const std::invalid_argument& error) {
              throw ArgumentFault("--symmetry", error.what());
            }
          },
          "the target looks the same after 1/FOLD of a turn about this axis of its frame, so errors are to "
          "the "
          "nearest such attitude; z:4, z:any or 0.5,0.5,0.7:2; may be repeated")
      ->allow_extra_args(false)
      ->type_name("AXIS:FOLD");
}

void print_symmetry(const TargetSymmetry& symmetry) {
  if (!symmetry.is_none()) fmt::print("  errors modulo the symmetry: {}\n\n", to_string(symmetry));
}

}  // namespace tumblesight::sim
