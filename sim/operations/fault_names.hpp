// The names of the flight program's faults, as in docs/icd.md.
#pragma once

#include <string>

#include "hal/messages/fault.hpp"

namespace tumblesight::sim {

// "FRAME_FROZEN". "FAULT 12" for a number that is not of a fault.
std::string name_of(hal::Fault fault);

}  // namespace tumblesight::sim
