// Elementary functions of integers and Fixed numbers. Norm and errors: docs/numerics.md.
#pragma once

#include <cstdint>

#include "gnc/numerics/fixed.hpp"

namespace tumblesight::gnc {

// Largest r with r^2 <= square. 32 steps whatever the number.
std::uint32_t integer_sqrt(std::uint64_t square);
// Position of the highest bit set, 0 for 0 and 1.
int highest_bit(std::uint64_t value);

// Within 2^-24 of the exact result each.
Fixed sqrt(Fixed x);     // of negative numbers 0
Fixed exp(Fixed x);      // saturates above ln 128
Fixed sigmoid(Fixed x);  // 1 / (1 + e^-x)

}  // namespace tumblesight::gnc
