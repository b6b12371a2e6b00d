// The names of the telecommands, as in docs/icd.md.
#pragma once

#include <string>

#include "hal/messages/function_code.hpp"

namespace tumblesight::sim {

// "SET_MODE". "FUNCTION 99" for a number that is not of a telecommand.
std::string name_of(hal::FunctionCode function);

}  // namespace tumblesight::sim
