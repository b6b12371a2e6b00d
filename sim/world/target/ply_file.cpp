#include "sim/world/target/ply_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sim/host/text.hpp"
#include "sim/world/target/cut_off.hpp"
#include "sim/world/target/file_lines.hpp"
#include "sim/world/target/mesh_builder.hpp"
#include "sim/world/target/ply_header.hpp"
#include "sim/world/target/polygon.hpp"

namespace tumblesight::sim {
namespace {

bool holds_corners(const PlyProperty& property) {
  return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
}

// The numbers behind the header, in the order in which they stand.
class PlyNumbers {
 public:
  PlyNumbers(std::string_view bytes, const PlyHeader& header)
      : format_(header.format),
        size_(bytes.size()),
        bytes_(bytes.substr(header.bytes)),
        lines_(bytes_),
        lines_before_(header.lines) {}

  // Each entry of an ASCII file has a line of its own.
  void begin_entry(const PlyElement& element, std::uint64_t entry) {
    element_ = &element;
    entry_ = entry;
    if (format_ != PlyFormat::kAscii || element.properties.empty()) return;
    do {
      if (!lines_.next(line_)) refuse_end();
    } while (without_outer_spaces(line_).empty());
  }

  // Numbers that no property announces are counted by element. They shift what is read, unless every entry of
  // the element has them.
  void end_entry() {
    if (format_ != PlyFormat::kAscii || without_outer_spaces(line_).empty()) return;
    line_ = {};
    if (longer_++ == 0) first_longer_ = line_number();
  }
  // After the last entry of an element. The note is empty if its lines were as announced.
  std::string end_element(const PlyElement& element) {
    const std::uint64_t longer = std::exchange(longer_, 0);
    const std::size_t first = std::exchange(first_longer_, 0);
    if (longer == 0) return {};
    if (longer < element.count)
      refuse_line(first, "has more numbers than the header announces for element " + in_quotes(element.name) +
                             " (" + std::to_string(longer) + " of its " + std::to_string(element.count) +
                             " lines); export the mesh again");
    return "each line of element " + in_quotes(element.name) +
           " has more numbers than the header announces, which are left out: what is read may be shifted. "
           "Compare the shape with the original";
  }

  double next(PlyType type) { return format_ == PlyFormat::kAscii ? next_of_line() : next_of_bytes(type); }

  // Bytes after the last element. Refuses what could be a further entry of it.
  std::size_t check_rest() const {
    const std::string_view rest = format_ == PlyFormat::kAscii ? without_outer_spaces(lines_.rest()) : bytes_;
    if (is_padding(rest)) return rest.size();
    throw std::runtime_error(
        "the header announces " + std::to_string(element_->count) +
        (element_->count == 1 ? " entry" : " entries") + " of element " + in_quotes(element_->name) +
        ", and " + counted(rest.size(), "byte") +
        " follow the last one: its count is wrong, or something was appended; export the "
        "mesh again");
  }
  std::size_t line_number() const { return lines_before_ + lines_.number(); }
  // What the rest of the file could hold at most.
  void check_count(const PlyElement& element) const {
    std::uint64_t least = 0;
    for (const PlyProperty& property : element.properties)
      least +=
          format_ == PlyFormat::kAscii ? 2 : size_of(property.is_list ? property.count_type : property.type);
    const std::uint64_t left = format_ == PlyFormat::kAscii ? lines_.rest().size() + 1 : bytes_.size();
    if (element.count * least <= left) return;
    throw std::runtime_error("the header announces " + std::to_string(element.count) +
                             " entries of element " + in_quotes(element.name) + ", which take at least " +
                             std::to_string(element.count * least) + " bytes, and " + std::to_string(left) +
                             " of the " + std::to_string(size_) +
                             " bytes of the file are left for them: it was cut off; copy or export it again");
  }
  [[noreturn]] void refuse_end() const {
    throw std::runtime_error("the file ends after " + std::to_string(size_) + " bytes within entry " +
                             std::to_string(entry_ + 1) + " of the " + std::to_string(element_->count) +
                             " of element " + in_quotes(element_->name) +
                             ": it was cut off; copy or export it again");
  }
  std::string place() const {
    return "element " + in_quotes(element_->name) + ", entry " + std::to_string(entry_ + 1);
  }

 private:
  // Text that is no number, zeros, or less than another entry.
  bool is_padding(std::string_view rest) const {
    if (format_ == PlyFormat::kAscii) return !number_of(next_word(rest));
    std::size_t least = 0;
    for (const PlyProperty& property : element_->properties) {
      if (property.is_list) least += size_of(property.count_type);
      least += (holds_corners(property) ? 3 : property.is_list ? 0 : 1) * size_of(property.type);
    }
    return rest.size() < least || rest.find_first_not_of('\0') == std::string_view::npos;
  }

  double next_of_line() {
    const std::string_view word = next_word(line_);
    if (word.empty() && lines_.rest().empty()) refuse_end();
    const std::optional<double> number = number_of(word);
    if (!number) refuse_number(line_number(), word);
    return *number;
  }

  template <typename T>
  T take() {
    if (bytes_.size() < sizeof(T)) refuse_end();
    unsigned char raw[sizeof(T)];
    for (std::size_t i = 0; i < sizeof(T); ++i)
      raw[format_ == PlyFormat::kLittleEndian ? i : sizeof(T) - 1 - i] =
          static_cast<unsigned char>(bytes_[i]);
    bytes_.remove_prefix(sizeof(T));
    T value{};  // of a little-endian machine, as all are that run this tool
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }

  double next_of_bytes(PlyType type) {
    switch (type) {
      case PlyType::kInt8:
        return take<std::int8_t>();
      case PlyType::kUint8:
        return take<std::uint8_t>();
      case PlyType::kInt16:
        return take<std::int16_t>();
      case PlyType::kUint16:
        return take<std::uint16_t>();
      case PlyType::kInt32:
        return take<std::int32_t>();
      case PlyType::kUint32:
        return take<std::uint32_t>();
      case PlyType::kFloat32:
        return take<float>();
      case PlyType::kFloat64:
        break;
    }
    return take<double>();
  }

  PlyFormat format_;
  std::size_t size_;
  std::string_view bytes_;
  FileLines lines_;
  std::size_t lines_before_;
  std::string_view line_;
  const PlyElement* element_ = nullptr;
  std::uint64_t entry_ = 0;
  std::uint64_t longer_ = 0;      // lines of the element with more numbers than announced
  std::size_t first_longer_ = 0;  // number of the first
};

class PlyReader {
 public:
  PlyReader(std::string_view bytes, const PlyHeader& header)
      : header_(header),
        numbers_(bytes, header),
        ends_within_line_(header.format == PlyFormat::kAscii && !has_last_line_end(bytes)) {}

  TriangleMesh read(const MeshFileOptions& options) {
    check_elements();
    for (const PlyElement& element : header_.elements) numbers_.check_count(element);
    for (const PlyElement& element : header_.elements) {
      for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
        numbers_.begin_entry(element, i);
        if (element.name == "vertex") {
          take_vertex(element);
        } else if (element.name == "face") {
          take_face(element);
        } else {
          skip(element);
        }
        numbers_.end_entry();
      }
      const std::string surplus = numbers_.end_element(element);
      if (!surplus.empty()) surplus_.push_back(surplus);
    }
    if (ends_within_line_) check_last_corner();
    return built(options);
  }

 private:
  void check_elements() const {
    std::uint64_t points = 0, faces = 0;
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") check_vertex_count(points += element.count);
      if (element.name == "face") faces += element.count;
      if (element.name == "tristrips")
        throw std::runtime_error(
            "its triangles are strips (element 'tristrips'), which are not read; export "
            "it with faces");
      if (element.name == "face" &&
          std::none_of(element.properties.begin(), element.properties.end(), holds_corners))
        throw std::runtime_error("element 'face' has no list 'vertex_indices'; export the mesh again");
      if (element.name == "vertex") check_axes(element);
    }
    if (faces == 0)
      throw std::runtime_error("is a cloud of " + counted(points, "point") +
                               " without faces; make a surface of it first, for instance in MeshLab (Filters "
                               "> Remeshing > Surface "
                               "Reconstruction: Screened Poisson) or CloudCompare (Plugins > Poisson), and "
                               "export this as PLY or STL");
  }
  static void check_axes(const PlyElement& element) {
    for (const char* axis : {"x", "y", "z"}) {
      const auto is_axis = [axis](const PlyProperty& property) {
        return !property.is_list && property.name == axis;
      };
      if (std::none_of(element.properties.begin(), element.properties.end(), is_axis))
        throw std::runtime_error(std::string("element 'vertex' has no property '") + axis +
                                 "'; export the mesh again");
    }
  }

  void take_vertex(const PlyElement& element) {
    Eigen::Vector3d& place = vertices_.emplace_back(Eigen::Vector3d::Zero());
    for (const PlyProperty& property : element.properties) {
      if (property.is_list) {
        take_list(property, nullptr);
        continue;
      }
      const double number = numbers_.next(property.type);
      const bool is_axis = property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z';
      if (is_axis) place[property.name[0] - 'x'] = number;
    }
  }

  void take_face(const PlyElement& element) {
    const std::size_t before = corners_.size();
    for (const PlyProperty& property : element.properties) {
      if (!property.is_list) {
        numbers_.next(property.type);
      } else {
        take_list(property, holds_corners(property) && corners_.size() == before ? &corners_ : nullptr);
      }
    }
    const std::size_t count = corners_.size() - before;
    if (count > kMostCorners)
      throw std::runtime_error(numbers_.place() + ": a polygon has " + std::to_string(count) +
                               " corners, at most " + std::to_string(kMostCorners) +
                               " are divided; triangulate it in the modelling tool");
    faces_.push_back(static_cast<std::uint32_t>(count));
    check_triangle_count(faces_.size());
  }

  void skip(const PlyElement& element) {
    for (const PlyProperty& property : element.properties) {
      if (property.is_list) {
        take_list(property, nullptr);
      } else {
        numbers_.next(property.type);
      }
    }
  }

  void take_list(const PlyProperty& property, std::vector<std::uint32_t>* list) {
    const double count = numbers_.next(property.count_type);
    if (!(count >= 0.0) || count > 4e9 || count != std::floor(count))
      throw std::runtime_error(numbers_.place() + ": the list " + in_quotes(property.name) + " has " +
                               std::to_string(count) + " entries; export the mesh again");
    for (auto left = static_cast<std::uint64_t>(count); left > 0; --left) {
      const double number = numbers_.next(property.type);
      if (list == nullptr) continue;
      if (!(number >= 0.0) || number >= 4e9 || number != std::floor(number))
        throw std::runtime_error(numbers_.place() + ": " + std::to_string(number) +
                                 " is no number of a vertex; export the mesh again");
      list->push_back(static_cast<std::uint32_t>(number));
    }
  }

  // The count of entries tells whether a line is missing, but not whether the last number is whole.
  void check_last_corner() const {
    const PlyElement& element = header_.elements.back();
    if (element.name != "face" || !holds_corners(element.properties.back()) || faces_.back() < 3) return;
    const std::uint32_t* last = corners_.data() + corners_.size() - faces_.back();
    LastCorner corner(last, faces_.back(), vertices_.size(), 0);
    const std::uint32_t* face = corners_.data();
    for (std::size_t i = 0; i + 1 < faces_.size(); face += faces_[i++]) corner.add(face, faces_[i]);
    corner.check(numbers_.line_number());
  }

  TriangleMesh built(const MeshFileOptions& options) {
    MeshBuilder builder(options, "face");
    PolygonDivider polygons;
    std::size_t first = 0, too_few = 0;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      if (faces_[i] >= 3) add(first, faces_[i], i + 1, builder, polygons);
      if (faces_[i] < 3) ++too_few;
      first += faces_[i];
    }
    if (too_few > 0)
      builder.add_note(counted(too_few, "face") + " of fewer than 3 corners left out: no ray hits them");
    const std::size_t rest = numbers_.check_rest();
    if (rest > 0) builder.add_note(counted(rest, "byte") + " after the last element left out");
    for (const std::string& surplus : surplus_) builder.add_loss(surplus);
    const std::string loss = polygons.loss("face");
    if (!loss.empty()) builder.add_loss(loss);
    return builder.finish();
  }

  void add(std::size_t first, std::size_t count, std::size_t face, MeshBuilder& builder,
           PolygonDivider& polygons) {
    places_.clear();
    std::uint32_t first_vertex = 0;
    bool is_finite = true;
    for (std::size_t i = first; i < first + count; ++i) {
      if (corners_[i] >= vertices_.size())
        throw std::runtime_error("face " + std::to_string(face) + " names vertex " +
                                 std::to_string(corners_[i]) + ", and the file has vertices 0 to " +
                                 std::to_string(static_cast<std::int64_t>(vertices_.size()) - 1) +
                                 "; export the mesh again");
      places_.push_back(vertices_[corners_[i]]);
      is_finite = is_finite && places_.back().allFinite();
      const std::uint32_t number = builder.add_vertex(places_.back(), face);
      if (i == first) first_vertex = number;
    }
    if (!is_finite) return;  // the builder refuses it
    for (const auto& [a, b, c] : polygons.divide(places_, face))
      builder.add_triangle(first_vertex + a, first_vertex + b, first_vertex + c);
  }

  const PlyHeader& header_;
  PlyNumbers numbers_;
  bool ends_within_line_;
  std::vector<std::string> surplus_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::uint32_t> corners_;  // of the faces
  std::vector<std::uint32_t> faces_;    // how many corners each has
  std::vector<Eigen::Vector3d> places_;
};

}  // namespace

TriangleMesh read_ply(std::string_view bytes, const MeshFileOptions& options) {
  const PlyHeader header = read_ply_header(bytes);
  return PlyReader(bytes, header).read(options);
}

}  // namespace tumblesight::sim
