// Text in columns: its width, and its division into lines. Text is UTF-8; every code point counts as one
// column.
#pragma once

#include <cstddef>
#include <string>

namespace tumblesight::sim {

std::size_t columns_of(const std::string& text);

// Breaks lines at spaces, so that none has more columns unless one word does.
std::string wrapped(const std::string& text, std::size_t columns);

}  // namespace tumblesight::sim
