#include "sim/world/target/stl_file.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

#include "sim/host/text.hpp"
#include "sim/world/target/file_lines.hpp"
#include "sim/world/target/mesh_builder.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::size_t kTitleBytes = 80;
constexpr std::size_t kHeadBytes = kTitleBytes + 4;  // with the count
constexpr std::size_t kTriangleBytes = 50;
constexpr std::size_t kNormalBytes = 12;

std::uint32_t u32_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
  return value;
}

float f32_at(std::string_view bytes, std::size_t at) {
  const std::uint32_t bits = u32_at(bytes, at);
  float value = 0.0F;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

std::size_t announced_bytes(std::string_view bytes) {
  return kHeadBytes + kTriangleBytes * static_cast<std::size_t>(u32_at(bytes, kTitleBytes));
}

// A binary file may begin with "solid", too: its size tells.
bool is_ascii(std::string_view bytes) {
  if (bytes.size() >= kHeadBytes && bytes.size() == announced_bytes(bytes)) return false;
  if (!looks_like_text(bytes)) return false;
  std::string_view rest = bytes;
  return in_lower_case(next_word(rest)) == "solid";
}

std::string sizes_text(std::string_view bytes) {
  const std::uint32_t count = u32_at(bytes, kTitleBytes);
  return "announces " + counted(count, "triangle") + ", which take " +
         std::to_string(announced_bytes(bytes)) + " bytes, and has " + std::to_string(bytes.size()) +
         " bytes";
}

// What follows the last triangle: less than another one, or padding.
bool is_no_triangle(std::string_view trailing) {
  return trailing.size() < kTriangleBytes || trailing.find_first_not_of('\0') == std::string_view::npos;
}

void check_sizes(std::string_view bytes, MeshBuilder& builder) {
  if (bytes.size() < kHeadBytes)
    throw std::runtime_error("cannot be read: an STL file begins with 'solid' or has at least " +
                             std::to_string(kHeadBytes) + " bytes, this one has " +
                             std::to_string(bytes.size()) + "; export it again");
  const std::size_t expected = announced_bytes(bytes);
  if (bytes.size() == expected) return;
  if (looks_like_text(bytes))
    throw std::runtime_error(
        "cannot be read: it is text that does not begin with 'solid', so no STL file; "
        "export it as STL, or give it the ending of its format");
  if (bytes.size() < expected)
    throw std::runtime_error(
        "cannot be read: it " + sizes_text(bytes) + ", " + std::to_string(expected - bytes.size()) +
        " too few: " + counted((bytes.size() - kHeadBytes) / kTriangleBytes, "triangle") +
        " are whole. It was cut off, or is no STL file; copy or export it again");
  const std::string_view trailing = bytes.substr(expected);
  if (!is_no_triangle(trailing))
    throw std::runtime_error("cannot be read: it " + sizes_text(bytes) + ", " +
                             std::to_string(trailing.size()) +
                             " too many: its count of triangles is wrong, or something was appended; export "
                             "it again");
  builder.add_note(counted(trailing.size(), "byte") + " after the last triangle left out");
}

void read_binary(std::string_view bytes, MeshBuilder& builder) {
  check_sizes(bytes, builder);
  const std::size_t count = u32_at(bytes, kTitleBytes);
  check_triangle_count(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t at = kHeadBytes + i * kTriangleBytes + kNormalBytes;
    std::array<std::uint32_t, 3> corners{};
    for (std::uint32_t& corner : corners) {
      corner = builder.add_vertex({f32_at(bytes, at), f32_at(bytes, at + 4), f32_at(bytes, at + 8)}, i + 1);
      at += 12;
    }
    builder.add_triangle(corners[0], corners[1], corners[2]);
  }
}

// The words of an ASCII file, which may be divided into lines in any way, except that names end with theirs.
class StlText {
 public:
  StlText(std::string_view text, MeshBuilder& builder) : lines_(text), builder_(builder) {}

  void read() {
    for (std::string_view word = next(); !word.empty(); word = next()) take(in_lower_case(word));
    if (is_open_) refuse_end();
    if (skipped_ > 0)
      builder_.add_note(counted(skipped_, "line") + " that STL does not define left out, the first is line " +
                        std::to_string(first_skipped_));
  }

 private:
  // The next word of the file; empty at its end.
  std::string_view next() {
    for (;;) {
      const std::string_view word = next_word(line_);
      if (!word.empty()) return word;
      if (!lines_.next(line_)) return {};
    }
  }

  void take(const std::string& word) {
    if (word == "solid") {
      is_open_ = true;
      skip_name();
    } else if (word == "endsolid") {
      if (in_facet_) refuse_here("'endsolid' stands within a facet");
      is_open_ = false;
      line_ = {};
    } else if (word == "facet") {
      if (in_facet_) refuse_here("'facet' stands within a facet");
      in_facet_ = true;
      corners_ = 0;
    } else if (word == "vertex") {
      take_vertex();
    } else if (word == "endfacet") {
      take_end_of_facet();
    } else if (word != "outer" && word != "loop" && word != "endloop") {
      take_other(word);
    }
  }

  // A name goes to the end of its line, unless the whole file is one line.
  void skip_name() {
    for (std::string_view name = line_; !name.empty();) {
      const std::string_view before = name;
      if (in_lower_case(next_word(name)) != "facet" || !is_begin_of_facet(name)) continue;
      line_ = before;
      return;
    }
    line_ = {};
  }
  // After "facet": the numbers of a normal, some of which may be missing, and "outer" or the end of the line.
  // A solid may be named "facet normal", too.
  static bool is_begin_of_facet(std::string_view words) {
    if (in_lower_case(next_word(words)) != "normal") return false;
    for (int numbers = 0; numbers < 3; ++numbers) {
      const std::string_view word = next_word(words);
      if (in_lower_case(word) == "outer") return true;
      if (!number_of(word)) return false;
    }
    const std::string_view after = next_word(words);
    return after.empty() || in_lower_case(after) == "outer";
  }

  void take_vertex() {
    if (!in_facet_) refuse_here("'vertex' stands outside of a facet");
    if (corners_ == corner_.size()) refuse_here("a facet has more than 3 vertices; export triangles");
    Eigen::Vector3d place;
    for (double& coordinate : place) {
      const std::string_view word = next();
      if (word.empty()) return;  // the end of the file is refused there
      const std::optional<double> number = number_of(word);
      if (!number && is_at_end()) refuse_end();
      if (!number) refuse_number(lines_.number(), word);
      coordinate = static_cast<float>(*number);  // as in binary
    }
    corner_[corners_++] = builder_.add_vertex(place, lines_.number());
  }

  void take_end_of_facet() {
    if (!in_facet_) refuse_here("'endfacet' stands outside of a facet");
    if (corners_ != corner_.size())
      refuse_here("a facet has " + std::to_string(corners_) + " vertices instead of 3");
    builder_.add_triangle(corner_[0], corner_[1], corner_[2]);
    in_facet_ = false;
  }

  void take_other(const std::string& word) {
    if (in_facet_ && corners_ == 0) return;  // the normal, which is not used, whatever it is
    if (in_facet_) refuse_here(in_quotes(word) + " is no word of a facet");
    if (skipped_++ == 0) first_skipped_ = lines_.number();
    line_ = {};
  }

  // What stands at the very end of a file that was cut off may be half a word or half a number.
  bool is_at_end() const { return without_outer_spaces(line_).empty() && lines_.rest().empty(); }

  [[noreturn]] void refuse_end() const {
    throw std::runtime_error("the file ends in line " + std::to_string(lines_.number()) +
                             " before 'endsolid', after " + counted(builder_.triangles(), "triangle") +
                             ": it was cut off, for instance by a full disk or a broken download; copy or "
                             "export it again");
  }

  [[noreturn]] void refuse_here(const std::string& why) const {
    if (is_at_end()) refuse_end();
    refuse_line(lines_.number(),
                why + (why.find("; ") == std::string::npos ? "; export the mesh again" : ""));
  }

  FileLines lines_;
  std::string_view line_;  // what is left of it
  MeshBuilder& builder_;
  bool is_open_ = false;
  bool in_facet_ = false;
  std::array<std::uint32_t, 3> corner_{};
  std::size_t corners_ = 0;
  std::size_t skipped_ = 0;
  std::size_t first_skipped_ = 0;
};

}  // namespace

TriangleMesh read_stl(std::string_view bytes, const MeshFileOptions& options) {
  const bool ascii = is_ascii(bytes);
  MeshBuilder builder(options, ascii ? "line" : "triangle");
  if (ascii) {
    StlText(bytes, builder).read();
  } else {
    read_binary(bytes, builder);
  }
  return builder.finish();
}

}  // namespace tumblesight::sim
