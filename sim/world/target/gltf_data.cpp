#include "sim/world/target/gltf_data.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>

#include "sim/world/target/file_lines.hpp"
#include "sim/world/target/mesh_file.hpp"

namespace tumblesight::sim::gltf {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 40U;  // that a number of the file may state
constexpr std::uint64_t kMaxStride = 253;
// Elements of an accessor that names no data: all are zero, unless a sparse part replaces them.
constexpr std::uint64_t kMaxWithoutData = 3 * kMaxTriangles;

std::string from_base64(const std::string& text, std::size_t begin, const std::string& where) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<int, 256> value{};
  value.fill(-1);
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    value[static_cast<unsigned char>(kDigits[i])] = static_cast<int>(i);
  std::size_t end = text.size();
  while (end > begin && text[end - 1] == '=') --end;
  std::string bytes;
  bytes.reserve((end - begin) / 4 * 3 + 3);
  std::uint32_t group = 0;
  unsigned bits = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const int digit = value[static_cast<unsigned char>(text[i])];
    if (digit < 0) fail(where + "'s data is damaged: it is not base64");
    group = group << 6U | static_cast<std::uint32_t>(digit);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> bits & 0xFFU);
  }
  return bytes;
}

std::string external_file(const fs::path& folder, const std::string& uri, std::uint64_t size,
                          const std::string& where) {
  const std::string named = where + " is the file " + shown_text(decoded_uri(uri)) + ", ";
  if (decoded_uri(uri).find('\0') != std::string::npos)
    refuse(where + " is at " + shown_text(uri) +
           ", and no file has a zero byte in its name; export it again");
  if (is_outside_address(uri)) {
    refuse(where + " is at " + shown_text(uri) +
           ": only files named relative to this one, in its folder or below, are read; put it beside this "
           "file and name it without a folder, or export one .glb file");
  }
  std::error_code error;
  const fs::path path = side_file(folder, uri);
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) refuse(named + "which is missing; put it there, or export one .glb file");
  if (!fs::is_regular_file(status)) refuse(named + "which is not a file; put the file there");
  std::ifstream file(path, std::ios::binary);
  const std::uint64_t available = fs::file_size(path, error);
  if (!file.is_open() || error) refuse(named + "which cannot be opened; check its permissions");
  std::string bytes(std::min(size, available), '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file.good()) refuse(named + "which cannot be read");
  return bytes;
}

std::string content_of_uri(const fs::path& folder, const std::string& uri, std::uint64_t size,
                           const std::string& where) {
  if (!is_data_uri(uri)) return external_file(folder, uri, size, where);
  const std::string kBase64 = ";base64";
  const std::size_t comma = std::min(uri.find(','), uri.size());
  const std::size_t mark = comma - std::min(comma, kBase64.size());
  if (comma == uri.size() || in_lower_case(std::string_view(uri).substr(mark, comma - mark)) != kBase64)
    fail(where + "'s data is not base64");
  return from_base64(uri, comma + 1, where);
}

template <typename T>
T read_at(const char* at) {
  T value{};
  std::memcpy(&value, at, sizeof(T));
  return value;
}

template <typename T>
T component_at(const char* at, std::uint64_t type) {
  switch (type) {
    case kByte:
      return static_cast<T>(read_at<std::int8_t>(at));
    case kUnsignedByte:
      return static_cast<T>(read_at<std::uint8_t>(at));
    case kShort:
      return static_cast<T>(read_at<std::int16_t>(at));
    case kUnsignedShort:
      return static_cast<T>(read_at<std::uint16_t>(at));
    case kUnsignedInt:
      return static_cast<T>(read_at<std::uint32_t>(at));
    default:
      return static_cast<T>(read_at<float>(at));
  }
}

// Where the elements of an accessor lie in a view, with a check that all of them do.
struct Layout {
  std::size_t count = 0, components = 0, component_bytes = 0, stride = 0;
  std::uint64_t type = 0;

  std::size_t element_bytes() const { return components * component_bytes; }

  const char* in(const Bytes& bytes, std::uint64_t offset, const std::string& where) const {
    if (count == 0) return bytes.data;
    const std::uint64_t needed = offset + (count - 1) * stride + element_bytes();
    if (needed > bytes.size) {
      fail(where + " needs " + std::to_string(needed) + " bytes of its buffer view, which has " +
           std::to_string(bytes.size));
    }
    return bytes.data + offset;
  }

  template <typename T>
  void copy(const char* from, std::size_t element, T* to) const {
    for (std::size_t i = 0; i < components; ++i)
      to[i] = component_at<T>(from + element * stride + i * component_bytes, type);
  }
};

std::uint64_t component_type_of(const json& object, const std::string& where) {
  const std::uint64_t type =
      whole(member(object, "componentType", where), kMaxBytes, where + "'s componentType");
  if (bytes_of(type) == 0)
    fail(where + "'s componentType is " + std::to_string(type) + ", which glTF does not have");
  return type;
}

bool is_unsigned(std::uint64_t type) {
  return type == kUnsignedByte || type == kUnsignedShort || type == kUnsignedInt;
}

Layout layout_of(const json& accessor, const std::string& where) {
  Layout layout;
  layout.count = whole(member(accessor, "count", where), kMaxBytes, where + "'s count");
  layout.type = component_type_of(accessor, where);
  layout.component_bytes = bytes_of(layout.type);
  layout.components = components_of(member(accessor, "type", where));
  if (layout.components == 0)
    fail(where + "'s type is " + shown(accessor["type"]) + ", which glTF does not have");
  layout.stride = layout.element_bytes();
  return layout;
}

}  // namespace

std::size_t components_of(const json& type) {
  struct Type {
    const char* name;
    std::size_t components;
  };
  for (const Type& known : {Type{"SCALAR", 1}, Type{"VEC2", 2}, Type{"VEC3", 3}, Type{"VEC4", 4},
                            Type{"MAT2", 4}, Type{"MAT3", 9}, Type{"MAT4", 16}}) {
    if (type == known.name) return known.components;
  }
  return 0;
}

std::size_t bytes_of(std::uint64_t component_type) {
  switch (component_type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

Data::Data(const File& file) : file_(file) {
  const json& buffers = list(file.scene, "buffers");
  buffers_.reserve(buffers.size());
  for (const json& buffer : buffers) {
    const std::string where = "buffer " + std::to_string(bytes_.size());
    const std::uint64_t size = whole(member(buffer, "byteLength", where), kMaxBytes, where + "'s byteLength");
    const json& uri = optional(buffer, "uri");
    if (!uri.is_null() && !uri.is_string()) fail(where + "'s uri is not a text");
    buffers_.push_back(uri.is_string()
                           ? content_of_uri(file.folder, uri.get_ref<const std::string&>(), size, where)
                           : std::string());
    const std::string& source = uri.is_string() ? buffers_.back() : file.binary;
    if (source.size() < size) {
      fail(where + " has " + std::to_string(source.size()) + " bytes, and its byteLength is " +
           std::to_string(size));
    }
    bytes_.push_back({source.data(), size});
  }
}

Bytes Data::view(const json& number, const std::string& where) const {
  const json& views = list(file_.scene, "bufferViews");
  const std::uint64_t chosen = whole(number, views.size(), where + "'s bufferView");
  const std::string name = "buffer view " + std::to_string(chosen);
  const json& view = views[chosen];
  const Bytes& buffer = bytes_[whole(member(view, "buffer", name), bytes_.size(), name + "'s buffer")];
  const std::uint64_t offset = whole_or(view, "byteOffset", 0, kMaxBytes, name);
  const std::uint64_t size = whole(member(view, "byteLength", name), kMaxBytes, name + "'s byteLength");
  if (offset + size > buffer.size) {
    fail(name + " ends at byte " + std::to_string(offset + size) + " of its buffer, which has " +
         std::to_string(buffer.size) + " bytes");
  }
  return {buffer.data + offset, size};
}

namespace {

// Replaces elements, as a sparse accessor says. `layout`: that of the accessor.
template <typename T>
void replace(const Data& data, const json& sparse, Layout layout, const std::string& where,
             std::vector<T>& values) {
  const std::size_t all = layout.count;
  const json& places = member(sparse, "indices", where);
  const json& others = member(sparse, "values", where);
  Layout at;
  at.count = layout.count = whole(member(sparse, "count", where), all + 1, where + "'s count");
  at.type = component_type_of(places, where + "'s indices");
  if (!is_unsigned(at.type)) fail(where + "'s indices are not whole numbers");
  at.components = 1;
  at.component_bytes = at.stride = bytes_of(at.type);
  layout.stride = layout.element_bytes();
  const auto first = [&](const json& from, const Layout& as, const std::string& what) {
    return as.in(data.view(member(from, "bufferView", what), what),
                 whole_or(from, "byteOffset", 0, kMaxBytes, what), what);
  };
  const char* place = first(places, at, where + "'s indices");
  const char* other = first(others, layout, where + "'s values");
  for (std::size_t i = 0; i < at.count; ++i) {
    const auto element = component_at<std::uint32_t>(place + i * at.stride, at.type);
    if (element >= all)
      fail(where + " replaces element " + std::to_string(element) + " of " + std::to_string(all));
    layout.copy(other, i, &values[element * layout.components]);
  }
}

template <typename T>
std::vector<T> values_of(const File& file, const Data& data, std::size_t accessor, const std::string& where) {
  const json& description = list(file.scene, "accessors")[accessor];
  const std::string name = where + " (accessor " + std::to_string(accessor) + ")";
  Layout layout = layout_of(description, name);
  const json& number = optional(description, "bufferView");
  if (number.is_null() && layout.count > kMaxWithoutData) {
    fail(name + " has " + std::to_string(layout.count) + " elements and no data");
  }
  const char* first = nullptr;
  if (!number.is_null()) {  // before the memory is taken: the count may be wrong
    const Bytes bytes = data.view(number, name);
    const json& view = list(file.scene, "bufferViews")[number.get<std::size_t>()];
    layout.stride = whole_or(view, "byteStride", layout.stride, kMaxStride, name + "'s buffer view");
    if (layout.stride < layout.element_bytes())
      fail(name + "'s elements overlap: its byteStride is too small");
    first = layout.in(bytes, whole_or(description, "byteOffset", 0, kMaxBytes, name), name);
  }
  std::vector<T> values(layout.count * layout.components, T{});
  for (std::size_t i = 0; first != nullptr && i < layout.count; ++i)
    layout.copy(first, i, &values[i * layout.components]);
  const json& sparse = optional(description, "sparse");
  if (!sparse.is_null()) replace(data, sparse, layout, name + "'s sparse part", values);
  return values;
}

}  // namespace

std::vector<float> Data::floats(std::size_t accessor, const std::string& where) const {
  return values_of<float>(file_, *this, accessor, where);
}

std::vector<std::uint32_t> Data::wholes(std::size_t accessor, const std::string& where) const {
  return values_of<std::uint32_t>(file_, *this, accessor, where);
}

}  // namespace tumblesight::sim::gltf
