// What a file holds, by its first bytes.
#pragma once

#include <string>
#include <string_view>

namespace tumblesight::sim {

// "a ZIP archive; unpack it and give the mesh in it": what the bytes are if they are no mesh of a format
// with this extension (".stl"), and what to do. Empty if they may be one.
std::string other_content(std::string_view bytes, std::string_view extension);

}  // namespace tumblesight::sim
