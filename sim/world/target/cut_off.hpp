// Evidence that a text mesh file ends before its mesh does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tumblesight::sim {

// Whether the last line of a text has a line end. Spaces and padding (NUL) may follow it. An end mark
// (Ctrl-Z) is as good.
bool has_last_line_end(std::string_view text);

// "seems to be cut off: <evidence>; ...": throws std::runtime_error.
[[noreturn]] void refuse_cut(const std::string& evidence);

// The vertices of a file, and which of them belong to something. The vertices of an object usually stand
// before its faces: those since the last face that vertices follow count on their own, too.
class VertexUse {
 public:
  void add_vertex();
  void begin_face() { in_faces_ = true; }
  void use(std::int64_t vertex);  // from 0; one that does not exist is passed over

  // "168 of 343 vertices belong to no face", or "... of the last 343 ...", if they are a larger share than
  // `share`, and at least `least`. Otherwise empty.
  std::string unused(double share, std::size_t least) const;

 private:
  std::string unused_from(std::size_t first, double share, std::size_t least) const;

  std::vector<bool> is_used_;
  std::size_t last_object_ = 0;
  bool in_faces_ = false;
};

// Whether the last corner of the last face is the beginning of a longer number, of which a cut has left the
// first digits: the face then fits the faces beside it with the longer number, and not as it is.
class LastCorner {
 public:
  // `face`: the corners of the last face, at least 3, counted from 0. `first`: the number of the first vertex
  // in the file.
  LastCorner(const std::uint32_t* face, std::size_t corners, std::size_t vertices, std::uint32_t first);

  // Takes every other face.
  void add(const std::uint32_t* face, std::size_t corners);
  // Refuses the file if the number probably was longer. `line`: of the face.
  void check(std::size_t line) const;

 private:
  void note(std::uint32_t from, std::uint32_t to);
  // A corner at the border of an open mesh may share no edge, so one that no other face has must fit better.
  bool fits_longer() const;

  std::uint32_t corner_, before_, after_;
  std::uint64_t vertices_, first_;
  bool is_known_ = false;                                    // another face has the corner, too
  std::vector<std::uint32_t> beside_before_, beside_after_;  // corners that share an edge with them
};

}  // namespace tumblesight::sim
