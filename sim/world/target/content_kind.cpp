#include "sim/world/target/content_kind.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "sim/world/target/file_lines.hpp"

namespace tumblesight::sim {
namespace {

constexpr const char* kUnpack = "unpack it and give the mesh in it";
constexpr const char* kImage = "give the mesh, not its texture or a picture of it";
constexpr const char* kDownload = "the download went wrong: open the address in a browser and save the file";

struct Kind {
  std::string_view start;  // lower case
  const char* name;
  const char* remedy;
  const char* extension = "";  // of the format itself
};
constexpr Kind kOfBytes[] = {
    {std::string_view("pk\x03\x04", 4), "a ZIP archive", kUnpack},
    {"\x1f\x8b", "a gzip archive", kUnpack},
    {"bzh", "a bzip2 archive", kUnpack},
    {std::string_view("\xfd"
                      "7zxz\0",
                      6),
     "an xz archive", kUnpack},
    {"7z\xbc\xaf\x27\x1c", "a 7z archive", kUnpack},
    {"rar!\x1a", "a RAR archive", kUnpack},
    {"\x89png\r\n", "a PNG image", kImage},
    {"\xff\xd8\xff", "a JPEG image", kImage},
    {"gif8", "a GIF image", kImage},
    {"%pdf-", "a PDF document", "give the mesh"},
    {"gltf", "a GLB file", "give it the ending .glb", ".glb"},
    {"kaydara fbx binary", "an FBX file", "open it in Blender and use File > Export > glTF 2.0 or STL"},
    {"blender", "a Blender file", "open it in Blender and use File > Export > glTF 2.0 or STL"},
    {"iso-10303-21", "a STEP file", "open it in FreeCAD or CAD Assistant and export it as STL or glTF"},
};
// Of these, spaces may stand before the first word.
constexpr Kind kOfText[] = {
    {"<!doctype html", "an HTML page", kDownload},
    {"<html", "an HTML page", kDownload},
    {"<?xml", "an XML file", "export the mesh as STL, OBJ, PLY or glTF"},
    {"version https://git-lfs", "a pointer of git-lfs, not the file itself", "fetch it with `git lfs pull`"},
    {"solid ", "an STL file", "give it the ending .stl", ".stl"},
    {"ply\n", "a PLY file", "give it the ending .ply", ".ply"},
    {"ply\r", "a PLY file", "give it the ending .ply", ".ply"},
};

std::string found(std::string_view start, const Kind* begin, const Kind* end, std::string_view extension) {
  const Kind* kind = std::find_if(
      begin, end, [start](const Kind& known) { return start.substr(0, known.start.size()) == known.start; });
  if (kind == end || kind->extension == extension) return {};
  return std::string(kind->name) + "; " + kind->remedy;
}

// A binary STL may begin with anything: its size tells.
bool is_binary_stl(std::string_view bytes) {
  if (bytes.size() < 84) return false;
  std::uint64_t count = 0;
  for (std::size_t i = 84; i > 80; --i) count = count << 8U | static_cast<std::uint8_t>(bytes[i - 1]);
  return bytes.size() == 84 + 50 * count;
}

}  // namespace

std::string other_content(std::string_view bytes, std::string_view extension) {
  if (extension == ".stl" && is_binary_stl(bytes)) return {};
  const std::string of_bytes =
      found(in_lower_case(bytes.substr(0, 64)), std::begin(kOfBytes), std::end(kOfBytes), extension);
  if (!of_bytes.empty()) return of_bytes;
  const std::size_t first = std::min(bytes.size(), bytes.find_first_not_of(" \t\r\n"));
  return found(in_lower_case(bytes.substr(first, 64)), std::begin(kOfText), std::end(kOfText), extension);
}

}  // namespace tumblesight::sim
