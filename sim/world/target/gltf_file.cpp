#include "sim/world/target/gltf_file.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <vector>

#include "sim/host/text.hpp"
#include "sim/world/target/file_lines.hpp"
#include "sim/world/target/mesh_file.hpp"

namespace tumblesight::sim::gltf {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHeaderBytes = 12;  // of a GLB file
constexpr std::size_t kChunkBytes = 8;    // of the header of a chunk

// Refuses duplicate keys, which parsers interpret differently, and deep nesting, which exhausts the stack. A
// pass of its own: the library's parser with a callback looks through a list again after each of its
// elements.
class Strict : public nlohmann::json_sax<json> {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override {
    keys_.emplace_back();
    return deeper();
  }
  bool end_object() override {
    keys_.pop_back();
    --depth_;
    return true;
  }
  bool start_array(std::size_t) override { return deeper(); }
  bool end_array() override {
    --depth_;
    return true;
  }
  bool key(string_t& name) override {
    if (!keys_.back().insert(name).second) fail("its JSON holds " + shown(name) + " twice in one object");
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const json::exception&) override {
    fail("its JSON is damaged");
  }

 private:
  bool deeper() {
    if (++depth_ > kMaxJsonDepth + 1)
      fail("its JSON is nested more than " + std::to_string(kMaxJsonDepth) + " deep");
    return true;
  }

  int depth_ = 0;
  std::vector<std::set<std::string>> keys_;
};

json parse(std::string_view text) {
  Strict strict;
  (void)json::sax_parse(text, &strict);
  json parsed = json::parse(text, nullptr, false);
  if (!parsed.is_object()) fail("its JSON is damaged");
  return parsed;
}

void check_size(std::uint64_t bytes) {
  if (bytes > kMaxJsonBytes) {
    fail("its JSON has " + std::to_string(bytes) + " bytes, more than " + std::to_string(kMaxJsonBytes));
  }
}

std::uint32_t u32_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8U | static_cast<std::uint8_t>(bytes[at + i]);
  return value;
}

std::string read(std::ifstream& file, std::uint64_t bytes) {
  std::string text(bytes, '\0');
  file.read(text.data(), static_cast<std::streamsize>(bytes));
  if (!file.good()) fail("it ends early");
  return text;
}

// The length that the header states. Bytes after it do not belong to the file.
std::uint64_t glb_length(std::ifstream& file, std::uint64_t size) {
  if (size < kHeaderBytes + kChunkBytes) fail("it does not begin as a GLB file does");
  const std::string header = read(file, kHeaderBytes);
  if (header.compare(0, 4, "glTF") != 0) {
    const bool is_json = header.find_first_not_of(" \t\r\n") != std::string::npos &&
                         header[header.find_first_not_of(" \t\r\n")] == '{';
    if (is_json) refuse("is a .gltf file by its content; give its name the ending .gltf");
    fail("it does not begin as a GLB file does");
  }
  if (u32_at(header, 4) != 2) fail("its version is " + std::to_string(u32_at(header, 4)) + ", not 2");
  const std::uint64_t length = u32_at(header, 8);
  if (length > size) {
    fail("its header states " + std::to_string(length) + " bytes, larger than the file of " +
         std::to_string(size) + " bytes: it is cut off");
  }
  return length;
}

struct Chunk {
  std::string type;
  std::uint64_t bytes;
};

// The header of the chunk that begins here; none at the end of the file.
std::optional<Chunk> next_chunk(std::ifstream& file, std::uint64_t at, std::uint64_t length) {
  if (at + kChunkBytes > length) return std::nullopt;
  const std::string header = read(file, kChunkBytes);
  const Chunk chunk{header.substr(4), u32_at(header, 0)};
  if (chunk.bytes > length - at - kChunkBytes) {
    fail("its part at byte " + std::to_string(at) + " states " + std::to_string(chunk.bytes) +
         " bytes and is larger than the file");
  }
  return chunk;
}

// The data is in the second chunk. Further ones are of extensions.
std::string glb_data(std::ifstream& file, std::uint64_t at, std::uint64_t length) {
  while (const std::optional<Chunk> chunk = next_chunk(file, at, length)) {
    if (chunk->type == std::string("BIN\0", 4)) return read(file, chunk->bytes);
    at += kChunkBytes + chunk->bytes;
    file.seekg(static_cast<std::streamoff>(at));
  }
  return {};
}

}  // namespace

void refuse(const std::string& why) {
  throw std::runtime_error(why);
}

void fail(const std::string& why) {
  refuse("cannot be read: " + why + "; export it again");
}

File read_glb(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::uint64_t length = glb_length(file, fs::file_size(path));
  const std::optional<Chunk> first = next_chunk(file, kHeaderBytes, length);
  if (!first || first->type != "JSON") fail("its first part is not JSON");
  check_size(first->bytes);
  std::string text = read(file, first->bytes);
  text.erase(text.find_last_not_of('\0') + 1);  // padding of some exporters
  File found{parse(text), {}, fs::path(path).parent_path()};
  found.binary = glb_data(file, kHeaderBytes + kChunkBytes + first->bytes, length);
  return found;
}

File read_gltf(const std::string& path) {
  check_size(fs::file_size(path));
  std::ifstream file(path, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(file), {}};
  const std::string_view text = without_byte_order_mark(content);
  if (text.compare(0, 4, "glTF") == 0) refuse("is a GLB file by its content; give its name the ending .glb");
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || text[first] != '{')
    fail("it does not begin with {, as a glTF file does");
  return {parse(text), {}, fs::path(path).parent_path()};
}

File read_file(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".glb" ? read_glb(path) : read_gltf(path);
}

const json& optional(const json& object, const char* key) {
  static const json kNone;
  if (!object.is_object()) return kNone;
  const auto found = object.find(key);
  return found == object.end() ? kNone : *found;
}

const json& member(const json& object, const char* key, const std::string& where) {
  if (!object.is_object()) fail(where + " is not an object");
  const auto found = object.find(key);
  if (found == object.end()) fail(where + " has no \"" + key + "\"");
  return *found;
}

const json& list(const json& object, const char* key) {
  static const json kNone = json::array();
  const json& found = optional(object, key);
  if (found.is_null()) return kNone;
  if (!found.is_array()) fail(std::string("\"") + key + "\" is not a list");
  return found;
}

std::uint64_t whole(const json& value, std::uint64_t limit, const std::string& where) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= limit) {
    fail(where + " is " + shown(value) + ", not a whole number below " + std::to_string(limit));
  }
  return value.get<std::uint64_t>();
}

std::uint64_t whole_or(const json& object, const char* key, std::uint64_t absent, std::uint64_t limit,
                       const std::string& where) {
  const json& value = optional(object, key);
  return value.is_null() ? absent : whole(value, limit, where + "'s " + key);
}

bool is_data_uri(const std::string& uri) {
  return in_lower_case(std::string_view(uri).substr(0, 5)) == "data:";
}

bool is_outside_address(const std::string& uri) {
  const std::string decoded = decoded_uri(uri);
  if (decoded.empty() || decoded[0] == '/' || decoded[0] == '\\') return true;
  const fs::path place = fs::path(decoded).lexically_normal();
  if (place.begin() != place.end() && *place.begin() == "..") return true;
  const std::size_t colon = uri.find(':');
  return colon != std::string::npos && std::isalpha(static_cast<unsigned char>(uri[0])) != 0 &&
         std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '+' || c == '.' || c == '-';
         });
}

fs::path side_file(const fs::path& folder, const std::string& uri) {
  const fs::path decoded = folder / decoded_uri(uri), literal = folder / uri;
  std::error_code error;
  return !fs::exists(decoded, error) && fs::exists(literal, error) ? literal : decoded;
}

std::string shown(const json& value) {
  return shortened(value.dump(-1, ' ', true, json::error_handler_t::replace));
}

std::string shown_text(const std::string& text) {
  return "'" + shortened(text) + "'";
}

}  // namespace tumblesight::sim::gltf
