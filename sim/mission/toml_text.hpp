// The text of a TOML file that a user wrote: read, and made into tables.
#pragma once

#include <toml++/toml.h>

#include <string>

namespace tumblesight::sim {

// `kind`: "mission" or "campaign", for messages. Throws std::invalid_argument that names file, fault, limit
// and remedy if it cannot be read, is no regular file, or is too large for one.
std::string read_toml(const std::string& path, const char* kind);

// Throws std::invalid_argument that names file, line and fault. Values and keys that are nested deeply are
// refused before they are parsed: the library builds and deletes tables by recursion.
toml::table parse_toml(const std::string& text, const std::string& file);

}  // namespace tumblesight::sim
