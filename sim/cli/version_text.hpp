#pragma once

#include <string>

namespace tumblesight::sim {

// Program version, commit, format version of model images, hash of the interface definition: one per line.
std::string version_text();

}  // namespace tumblesight::sim
