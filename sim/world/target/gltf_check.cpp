#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <vector>

#include "sim/terminal/text.hpp"
#include "sim/world/target/mesh_file.hpp"

namespace tumblesight::sim {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 32;
constexpr std::uint64_t kMaxElements = 100'000'000;
constexpr std::size_t kGlbHeaderBytes = 20;  // 12 of the file and 8 of its first chunk

[[noreturn]] void fail(const std::string& why) {
  throw std::runtime_error("cannot be read: " + why + "; export it again");
}

// Refuses duplicate keys, which parsers interpret differently, and deep nesting, which exhausts the stack.
class Strict {
 public:
  bool operator()(int depth, json::parse_event_t event, const json& parsed) {
    if (depth > kMaxDepth) fail("its JSON is nested more than " + std::to_string(kMaxDepth) + " deep");
    if (event == json::parse_event_t::object_start) keys_.emplace_back();
    if (event == json::parse_event_t::object_end) keys_.pop_back();
    if (event == json::parse_event_t::key && !keys_.back().insert(parsed.get<std::string>()).second) {
      fail("its JSON holds " + shortened(parsed.dump()) + " twice in one object");
    }
    return true;
  }

 private:
  std::vector<std::set<std::string>> keys_;
};

json parse(const std::string& text) {
  Strict strict;
  try {
    return json::parse(text, [&strict](int depth, json::parse_event_t event, const json& parsed) {
      return strict(depth, event, parsed);
    });
  } catch (const json::exception&) {
    fail("its JSON is damaged");
  }
}

const json& member(const json& object, const char* key, const std::string& where) {
  if (!object.is_object()) fail(where + " is not an object");
  const auto found = object.find(key);
  if (found == object.end()) fail(where + " has no \"" + key + "\"");
  return *found;
}

// An optional array; empty if absent.
const json& list(const json& object, const char* key) {
  static const json kNone = json::array();
  const auto found = object.find(key);
  if (found == object.end()) return kNone;
  if (!found->is_array()) fail(std::string("\"") + key + "\" is not a list");
  return *found;
}

std::uint64_t whole(const json& value, std::uint64_t limit, const std::string& where) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= limit) {
    fail(where + " is " + shortened(value.dump(-1, ' ', true, json::error_handler_t::replace)) +
         ", not a whole number below " + std::to_string(limit));
  }
  return value.get<std::uint64_t>();
}

using Counts = std::vector<std::uint64_t>;  // elements per accessor

Counts accessor_counts(const json& file) {
  Counts counts;
  for (const json& accessor : list(file, "accessors")) {
    const std::string where = "accessor " + std::to_string(counts.size());
    counts.push_back(whole(member(accessor, "count", where), kMaxElements, where + "'s count"));
  }
  return counts;
}

std::uint64_t count_of(const json& accessor, const Counts& counts, const std::string& where) {
  return counts[whole(accessor, counts.size(), where)];
}

// What changes the surface and is not read. Other extensions concern materials, lights or animations.
struct UnreadExtension {
  const char* name;
  const char* remedy;
};
constexpr UnreadExtension kUnread[] = {
    {"EXT_meshopt_compression", "is compressed with meshoptimizer; export it without compression"},
    {"EXT_mesh_gpu_instancing", "repeats its parts by instancing; export it with every part written out"},
};

void check_extensions(const json& file) {
  for (const json& used : list(file, "extensionsUsed")) {
    for (const auto& [name, remedy] : kUnread) {
      if (used == name)
        throw std::runtime_error(std::string("uses ") + name + ", which is not read: it " + remedy);
    }
  }
}

// Assimp takes other numbers for single precision.
void check_positions(const json& file, const json& accessor) {
  constexpr unsigned kFloat = 5126;
  const auto& accessors = list(file, "accessors");
  const json& positions = accessors[accessor.get<std::size_t>()];
  if (positions.value("componentType", json(kFloat)) == kFloat) return;
  throw std::runtime_error(
      "has positions in whole numbers (KHR_mesh_quantization), which are not read; export it without "
      "quantization");
}

// By primitive mode: points, lines, line loop, line strip, triangles, triangle strip, triangle fan.
constexpr std::array<std::uint64_t, 7> kMinCorners{1, 2, 2, 2, 3, 3, 3};

void check_primitive(const json& file, const json& primitive, const Counts& counts,
                     const std::string& where) {
  const json& attributes = member(primitive, "attributes", where);
  const json& positions = member(attributes, "POSITION", where + "'s attributes");
  std::uint64_t elements = count_of(positions, counts, where + "'s POSITION");
  check_positions(file, positions);
  for (const auto& [name, accessor] : attributes.items()) {
    if (count_of(accessor, counts, where + "'s attribute") != elements) {
      fail(where + " has attributes of different counts");
    }
  }
  const auto indices = primitive.find("indices");
  if (indices != primitive.end()) elements = count_of(*indices, counts, where + "'s indices");
  const std::uint64_t mode = whole(primitive.value("mode", json(4U)), kMinCorners.size(), where + "'s mode");
  if (elements < kMinCorners[mode]) {
    fail(where + " of mode " + std::to_string(mode) + " has " + std::to_string(elements) +
         " corners, fewer than " + std::to_string(kMinCorners[mode]));
  }
}

void check_json(const std::string& text) {
  const json file = parse(text);
  const json& version = member(member(file, "asset", "its JSON"), "version", "its asset");
  if (!version.is_string() || version.get_ref<const std::string&>().rfind("2.", 0) != 0)
    fail("it is not glTF 2");
  check_extensions(file);
  const Counts counts = accessor_counts(file);
  std::size_t mesh_number = 0;
  for (const json& mesh : list(file, "meshes")) {
    const std::string where = "mesh " + std::to_string(mesh_number++);
    std::size_t number = 0;
    if (!mesh.is_object()) fail(where + " is not an object");
    for (const json& primitive : list(mesh, "primitives")) {
      check_primitive(file, primitive, counts, where + "'s primitive " + std::to_string(number++));
    }
  }
}

}  // namespace

void check_gltf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || text[first] != '{') fail("it does not begin with {, as a glTF file does");
  check_json(text);
}

void check_glb(const std::string& path) {
  std::array<std::uint8_t, kGlbHeaderBytes> header{};
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(header.data()), header.size());
  if (!file.good() || !std::equal(header.begin(), header.begin() + 4, "glTF")) {
    fail("it does not begin as a GLB file does");
  }
  const auto u32 = [&header](std::size_t at) {
    return std::uint32_t{header[at]} | std::uint32_t{header[at + 1]} << 8 |
           std::uint32_t{header[at + 2]} << 16 | std::uint32_t{header[at + 3]} << 24;
  };
  const std::uintmax_t size = std::filesystem::file_size(path);
  if (u32(8) > size || u32(12) > size - header.size()) fail("its parts are larger than the file");
  if (!std::equal(header.begin() + 16, header.end(), "JSON")) fail("its first part is not JSON");
  std::string text(u32(12), '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.erase(text.find_last_not_of('\0') + 1);  // padding of some exporters
  check_json(text);
}

}  // namespace tumblesight::sim
