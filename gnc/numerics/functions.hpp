// Elementary functions of integers and of Fixed (Q7.24). Definitions and errors: docs/numerics.md. The
// instruction count of each does not depend on its argument.
#pragma once

#include <cstdint>

#include "gnc/numerics/fixed.hpp"

namespace tumblesight::gnc {

// Largest r with r^2 <= square. Exact; 32 iterations.
std::uint32_t integer_sqrt(std::uint64_t square);
// Index of the highest bit that is set, 0 to 63; 0 for the values 0 and 1.
int highest_bit(std::uint64_t value);

// Square root, error at most 2^-24. Negative arguments give 0.
Fixed sqrt(Fixed x);
// e^x, error at most 2^-24 for x <= 0 and relative 1e-8 above. Saturates for x > ln 128.
Fixed exp(Fixed x);
// Logistic function 1 / (1 + e^-x), error at most 2^-23.
Fixed sigmoid(Fixed x);

}  // namespace tumblesight::gnc
