// A glTF 2.0 file as it is on the disk: its JSON and, of a GLB file, its binary data. What all readers of
// glTF share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <string>

namespace tumblesight::sim::gltf {

using nlohmann::json;

struct File {
  json scene;
  std::string binary;  // the binary chunk of a GLB file
  std::filesystem::path folder;
};

// JSON of exporters is about ten levels deep. Deeper nesting exhausts the stack of parsers that recurse.
inline constexpr int kMaxJsonDepth = 32;
inline constexpr std::uint64_t kMaxJsonBytes = std::uint64_t{1} << 30U;  // data URIs included

// The GLB file, or the .gltf file. All functions here throw std::runtime_error that says what is wrong,
// without the name of the file. What they show of the file is shortened and printable.
File read_glb(const std::string& path);
File read_gltf(const std::string& path);
File read_file(const std::string& path);  // as the ending of its name says

[[noreturn]] void fail(const std::string& why);    // "cannot be read: ...; export it again"
[[noreturn]] void refuse(const std::string& why);  // as it is

// Null if there is none, or if it is no object.
const json& optional(const json& object, const char* key);
// `where`: what the object is, for the message.
const json& member(const json& object, const char* key, const std::string& where);
// Empty if absent.
const json& list(const json& object, const char* key);
// A whole number below `limit`.
std::uint64_t whole(const json& value, std::uint64_t limit, const std::string& where);
std::uint64_t whole_or(const json& object, const char* key, std::uint64_t absent, std::uint64_t limit,
                       const std::string& where);
// Whether a URI is data itself ("data:..."), and whether it leads elsewhere than into the folder of the file
// and those below it: "https://...", "/absolute", "../other".
bool is_data_uri(const std::string& uri);
bool is_outside_address(const std::string& uri);
// The file that a relative URI names. URIs are percent-encoded; some exporters forget it, so the name as it
// is written counts if only that file is there.
std::filesystem::path side_file(const std::filesystem::path& folder, const std::string& uri);

// What a reading of the file gives. A value of another kind than the standard has becomes a refusal, and so
// does a lack of memory.
template <typename Reading>
auto guarded(const Reading& reading) -> decltype(reading()) {
  try {
    return reading();
  } catch (const json::exception&) {
    fail("its JSON holds a value of another kind than glTF has there");
  } catch (const std::bad_alloc&) {
    refuse("needs more memory than there is; simplify it in the modelling tool");
  }
}

// A value of the file in a message.
std::string shown(const json& value);
std::string shown_text(const std::string& text);  // in quotes

}  // namespace tumblesight::sim::gltf
