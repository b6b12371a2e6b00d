#include "sim/world/target/obj_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <unordered_map>
#include <vector>

#include "sim/host/text.hpp"
#include "sim/world/target/cut_off.hpp"
#include "sim/world/target/file_lines.hpp"
#include "sim/world/target/mesh_builder.hpp"
#include "sim/world/target/obj_statements.hpp"
#include "sim/world/target/polygon.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestLibrary_bytes = 64U << 20U;

// More vertices without a face than these shares tell of faces that are missing.
constexpr double kMostUnusedWithoutLineEnd = 0.1;
constexpr double kMostUnused = 0.5;

// The names of materials, numbered in the order in which they come.
class Materials {
 public:
  std::uint32_t number_of(const std::string& name) {
    const auto [entry, is_new] = numbers_.try_emplace(name, static_cast<std::uint32_t>(is_panel_.size()));
    if (is_new) is_panel_.push_back(names_a_panel(name));
    return entry->second;
  }
  void add_library(const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error) || fs::file_size(path, error) > kLargestLibrary_bytes || error)
      return;
    std::ifstream file(path, std::ios::binary);
    for (std::string line; std::getline(file, line);) {
      std::string_view words = line;
      if (next_word(words) == "newmtl") number_of(std::string(without_outer_spaces(words)));
    }
  }
  bool is_panel(std::uint32_t number) const { return is_panel_[number]; }

 private:
  std::unordered_map<std::string, std::uint32_t> numbers_;
  std::vector<bool> is_panel_;
};

struct Face {
  std::size_t first;  // of its corners
  std::size_t line;
  std::uint32_t corners;
  std::uint32_t material;
};

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& path)
      : statements_(text), path_(path), has_line_end_(has_last_line_end(text)) {
    material_ = materials_.number_of("");  // of faces before the first name
  }

  TriangleMesh read(const MeshFileOptions& options) {
    std::string_view keyword, words;
    while (statements_.next(keyword, words)) {
      if (!has_line_end_ && statements_.is_last() && !is_whole_statement(keyword, words))
        refuse_cut("the statement in its last line, line " + std::to_string(statements_.number()) +
                   ", is not complete");
      take(keyword, words);
    }
    MeshBuilder builder(options, "line");
    check_end(builder);
    PolygonDivider polygons;
    std::stable_sort(faces_.begin(), faces_.end(),
                     [](const Face& a, const Face& b) { return a.material < b.material; });
    for (const Face& face : faces_) add(face, builder, polygons);
    add_notes(builder, polygons);
    return builder.finish();
  }

 private:
  void take(std::string_view keyword, std::string_view words) {
    if (keyword == "v") {
      take_vertex(words);
    } else if (keyword == "f" || keyword == "fo") {
      take_face(words);
    } else if (keyword == "l" || keyword == "p") {
      ++(keyword == "l" ? lines_ : points_);
      take_other_corners(words);
    } else if (keyword == "usemtl") {
      const std::string name(without_outer_spaces(words));
      if (!name.empty()) material_ = materials_.number_of(name);
    } else if (keyword == "mtllib") {
      take_library(words);
    } else if (keyword == "surf" || keyword == "bzp" || keyword == "bsp") {
      refuse_line(statements_.number(), "a free-form surface (" + in_quotes(keyword) +
                                            ") is not read; export the surface as polygons or triangles");
    }
  }

  void take_vertex(std::string_view words) {
    double numbers[4] = {0.0, 0.0, 0.0, 1.0};
    std::size_t count = 0;
    for (std::string_view word = next_word(words); !word.empty(); word = next_word(words)) {
      if (count == 4) {
        ++count;  // a colour follows, and the fourth number belongs to it
        break;
      }
      const std::optional<double> number = number_of(word);
      if (!number) refuse_number(statements_.number(), word);
      numbers[count++] = *number;
    }
    if (count < 3)
      refuse_line(statements_.number(),
                  "a vertex has " + counted(count, "coordinate") + " instead of 3; export the mesh again");
    const double weight = count == 4 ? numbers[3] : 1.0;
    for (double& value : numbers) value = static_cast<float>(value);  // as all that follows
    check_vertex_count(vertices_.size() + 1);
    use_.add_vertex();
    vertices_.emplace_back(Eigen::Vector3d(numbers[0], numbers[1], numbers[2]) / weight);
    if (!vertices_.back().allFinite()) line_of_bad_.emplace(vertices_.size() - 1, statements_.number());
  }

  // "12", "12/3", "12//4", "12/3/4": the first number counts. Below 0 it counts back from the last vertex.
  std::int64_t corner_of(std::string_view word) const {
    const std::optional<double> number = tumblesight::sim::number_of(word.substr(0, word.find('/')));
    if (!number || *number != std::floor(*number) || !(std::abs(*number) < 4e9) || *number == 0.0)
      refuse_line(statements_.number(),
                  in_quotes(word) + " is no number of a vertex: they begin at 1; export the mesh again");
    const auto index = static_cast<std::int64_t>(*number);
    return index > 0 ? index - 1 : index + static_cast<std::int64_t>(vertices_.size());
  }

  void take_face(std::string_view words) {
    Face face{corners_.size(), statements_.number(), 0, material_};
    for (std::string_view word = next_word(words); !word.empty(); word = next_word(words)) {
      const std::int64_t corner = corner_of(word);
      if (corner < 0 || corner >= std::int64_t{~std::uint32_t{0}}) refuse_corner(face.line, word);
      corners_.push_back(static_cast<std::uint32_t>(corner));
      ++face.corners;
    }
    if (face.corners == 0) refuse_line(face.line, "a face has no corners; export the mesh again");
    if (face.corners > kMostCorners)
      refuse_line(face.line, "a polygon has " + std::to_string(face.corners) + " corners, at most " +
                                 std::to_string(kMostCorners) +
                                 " are divided; triangulate it in the modelling tool");
    if (face.corners < 3) {
      ++(face.corners == 1 ? points_ : lines_);
      other_corners_.insert(other_corners_.end(), corners_.begin() + static_cast<std::ptrdiff_t>(face.first),
                            corners_.end());
      corners_.resize(face.first);
      return;
    }
    faces_.push_back(face);
    use_.begin_face();
    check_triangle_count(faces_.size());
  }

  [[noreturn]] void refuse_corner(std::size_t line, std::string_view word) const {
    refuse_line(line, "the face names vertex " + std::string(word.substr(0, kMostOfAValue)) +
                          ", and the file has " + std::to_string(vertices_.size()) +
                          "; export the mesh again");
  }

  // Of lines and points. They are not shown, so no word is refused.
  void take_other_corners(std::string_view words) {
    for (std::string_view word = next_word(words); !word.empty(); word = next_word(words)) {
      const std::optional<double> number = tumblesight::sim::number_of(word.substr(0, word.find('/')));
      if (!number || !(std::abs(*number) < 4e9)) continue;
      const auto index = static_cast<std::int64_t>(*number);
      other_corners_.push_back(index > 0 ? index - 1 : index + static_cast<std::int64_t>(vertices_.size()));
    }
  }

  // Whether the file ends before its mesh does.
  void check_end(MeshBuilder& builder) {
    if (faces_.empty()) return;
    for (const std::uint32_t corner : corners_) use_.use(corner);
    for (const std::int64_t corner : other_corners_) use_.use(corner);
    if (has_line_end_) {
      const std::string unused = use_.unused(kMostUnused, 3);
      if (!unused.empty())
        builder.add_loss(
            unused +
            ": faces may be missing, for instance since the file was cut off. Compare it with the "
            "original");
      return;
    }
    const std::string unused = use_.unused(kMostUnusedWithoutLineEnd, 1);
    if (!unused.empty()) refuse_cut("its last line has no line end, and " + unused);
    if (faces_.back().line == statements_.number()) check_last_corner();
    builder.add_note("the last line has no line end: if the file was cut off there, faces are missing");
  }

  void check_last_corner() const {
    const Face& last = faces_.back();
    LastCorner corner(&corners_[last.first], last.corners, vertices_.size(), 1);
    for (const Face& face : faces_) {
      if (face.first != last.first) corner.add(&corners_[face.first], face.corners);
    }
    corner.check(last.line);
  }

  // After "mtllib": one name, which may hold spaces, or several.
  void take_library(std::string_view words) {
    const fs::path folder = fs::path(path_).parent_path();
    const std::string whole(without_outer_spaces(words));
    std::error_code error;
    if (whole.empty()) return;
    if (fs::is_regular_file(folder / whole, error)) return materials_.add_library(folder / whole);
    bool any = false;
    for (std::string_view word = next_word(words); !word.empty(); word = next_word(words)) {
      const fs::path library = folder / std::string(word);
      any = any || fs::is_regular_file(library, error);
      materials_.add_library(library);
    }
    if (!any) materials_.add_library(fs::path(path_).replace_extension(".mtl"));
  }

  void add(const Face& face, MeshBuilder& builder, PolygonDivider& polygons) {
    places_.clear();
    bool is_finite = true;
    std::uint32_t first = 0;
    for (std::size_t i = face.first; i < face.first + face.corners; ++i) {
      if (corners_[i] >= vertices_.size()) refuse_corner(face.line, std::to_string(corners_[i] + 1));
      const Eigen::Vector3d& place = vertices_[corners_[i]];
      const auto bad = place.allFinite() ? line_of_bad_.end() : line_of_bad_.find(corners_[i]);
      is_finite = is_finite && bad == line_of_bad_.end();
      const std::uint32_t number =
          builder.add_vertex(place, bad == line_of_bad_.end() ? face.line : bad->second);
      if (i == face.first) first = number;
      places_.push_back(place);
    }
    if (!is_finite) return;  // the builder refuses it
    const bool is_panel = materials_.is_panel(face.material);
    for (const auto& [a, b, c] : polygons.divide(places_, face.line))
      builder.add_triangle(first + a, first + b, first + c, is_panel);
  }

  void add_notes(MeshBuilder& builder, const PolygonDivider& polygons) const {
    if (lines_ + points_ > 0)
      builder.add_note(counted(lines_, "statement") + " of lines and " + std::to_string(points_) +
                       " of points left out: no ray hits them");
    const std::string loss = polygons.loss("line");
    if (!loss.empty()) builder.add_loss(loss);
  }

  ObjStatements statements_;
  std::string path_;
  bool has_line_end_;
  Materials materials_;
  std::uint32_t material_ = 0;
  std::vector<Eigen::Vector3d> vertices_;
  std::unordered_map<std::size_t, std::size_t> line_of_bad_;  // of vertices that are not finite
  std::vector<std::uint32_t> corners_;                        // of the faces
  std::vector<std::int64_t> other_corners_;                   // of lines and points
  VertexUse use_;
  std::vector<Face> faces_;
  std::vector<Eigen::Vector3d> places_;  // of one face
  std::size_t lines_ = 0;
  std::size_t points_ = 0;
};

}  // namespace

TriangleMesh read_obj(std::string_view text, const std::string& path, const MeshFileOptions& options) {
  if (!looks_like_text(text))
    throw std::runtime_error(
        "cannot be read: an OBJ file is text, and this one is not; export it as OBJ, or "
        "give it the ending of its format");
  return ObjReader(text, path).read(options);
}

}  // namespace tumblesight::sim
