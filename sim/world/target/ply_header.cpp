#include "sim/world/target/ply_header.hpp"

#include <array>
#include <charconv>
#include <stdexcept>
#include <utility>

#include "sim/world/target/file_lines.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::size_t kMostHeaderLines = 10'000;

constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes{{{"char", PlyType::kInt8},
                                                                       {"int8", PlyType::kInt8},
                                                                       {"uchar", PlyType::kUint8},
                                                                       {"uint8", PlyType::kUint8},
                                                                       {"short", PlyType::kInt16},
                                                                       {"int16", PlyType::kInt16},
                                                                       {"ushort", PlyType::kUint16},
                                                                       {"uint16", PlyType::kUint16},
                                                                       {"int", PlyType::kInt32},
                                                                       {"int32", PlyType::kInt32},
                                                                       {"uint", PlyType::kUint32},
                                                                       {"uint32", PlyType::kUint32},
                                                                       {"float", PlyType::kFloat32},
                                                                       {"float32", PlyType::kFloat32},
                                                                       {"double", PlyType::kFloat64},
                                                                       {"float64", PlyType::kFloat64}}};

PlyType type_named(std::string_view name, std::size_t line) {
  for (const auto& [known, type] : kTypes) {
    if (known == name) return type;
  }
  refuse_line(line, in_quotes(name) + " is no type of PLY; export the mesh again");
}

PlyFormat format_named(std::string_view name, std::size_t line) {
  if (name == "ascii") return PlyFormat::kAscii;
  if (name == "binary_little_endian") return PlyFormat::kLittleEndian;
  if (name == "binary_big_endian") return PlyFormat::kBigEndian;
  refuse_line(
      line,
      in_quotes(name) +
          " is no format of PLY: ascii, binary_little_endian or binary_big_endian; export the mesh again");
}

PlyElement element_of(std::string_view words, std::size_t line) {
  PlyElement element;
  element.name = std::string(next_word(words));
  const std::string_view count = next_word(words);
  const char* const end = count.data() + count.size();
  const auto [stop, error] = std::from_chars(count.data(), end, element.count);
  if (count.empty() || stop != end || error != std::errc() || element.count > 4'000'000'000U)
    refuse_line(line, "the count of element " + in_quotes(element.name) + " is " + in_quotes(count) +
                          ", it must be a number from 0 to 4000000000; export the mesh again");
  return element;
}

PlyProperty property_of(std::string_view words, std::size_t line) {
  PlyProperty property;
  std::string_view type = next_word(words);
  property.is_list = type == "list";
  if (property.is_list) {
    property.count_type = type_named(next_word(words), line);
    type = next_word(words);
  }
  property.type = type_named(type, line);
  property.name = std::string(next_word(words));
  return property;
}

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kFloat64:
      break;
  }
  return 8;
}

PlyHeader read_ply_header(std::string_view bytes) {
  FileLines lines(bytes);
  std::string_view line;
  if (!lines.next(line) || without_outer_spaces(line) != "ply")
    throw std::runtime_error(
        "cannot be read: a PLY file begins with the line 'ply'; export it as PLY, or give it the ending of "
        "its format");
  PlyHeader header;
  bool has_format = false;
  while (lines.number() < kMostHeaderLines && lines.next(line)) {
    std::string_view words = line;
    const std::string_view keyword = next_word(words);
    const std::size_t number = lines.number();
    if (keyword == "end_header") {
      if (!has_format) refuse_line(number, "the header has no 'format'; export the mesh again");
      header.bytes = bytes.size() - lines.rest().size();
      header.lines = number;
      return header;
    } else if (lines.rest().empty()) {
      break;  // half a line of a file that was cut off
    } else if (keyword == "format") {
      header.format = format_named(next_word(words), number);
      has_format = true;
    } else if (keyword == "element") {
      header.elements.push_back(element_of(words, number));
    } else if (keyword == "property") {
      if (header.elements.empty())
        refuse_line(number, "a property stands before the first element; export the mesh again");
      header.elements.back().properties.push_back(property_of(words, number));
    } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
      refuse_line(number, in_quotes(keyword) + " is no word of a PLY header; export the mesh again");
    }
  }
  throw std::runtime_error("cannot be read: its header of " + std::to_string(lines.number()) +
                           " lines does not end with 'end_header': it was cut off; copy or export it again");
}

}  // namespace tumblesight::sim
