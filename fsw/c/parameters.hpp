// The parameters of the C interface as the application's table.
#pragma once

#include "fsw/app/parameter_table.hpp"
#include "fsw/c/tumblesight_c.h"

namespace tumblesight::fsw::c {

ParameterTable table_of(const tumblesight_parameters& parameters);

}  // namespace tumblesight::fsw::c
