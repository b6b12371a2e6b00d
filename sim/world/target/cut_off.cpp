#include "sim/world/target/cut_off.hpp"

#include <algorithm>
#include <stdexcept>

namespace tumblesight::sim {
namespace {

bool holds(const std::vector<std::uint32_t>& corners, std::uint32_t corner) {
  return std::find(corners.begin(), corners.end(), corner) != corners.end();
}

}  // namespace

bool has_last_line_end(std::string_view text) {
  constexpr std::string_view kPadding(" \t\0", 3);
  const std::size_t last = text.find_last_not_of(kPadding);
  return last == std::string_view::npos || text[last] == '\n' || text[last] == '\r' || text[last] == '\x1a';
}

void refuse_cut(const std::string& evidence) {
  throw std::runtime_error("seems to be cut off: " + evidence +
                           "; copy or export it again, or end its last line if it is whole");
}

void VertexUse::add_vertex() {
  if (in_faces_) last_object_ = is_used_.size();
  in_faces_ = false;
  is_used_.push_back(false);
}

void VertexUse::use(std::int64_t vertex) {
  if (vertex >= 0 && static_cast<std::uint64_t>(vertex) < is_used_.size())
    is_used_[static_cast<std::size_t>(vertex)] = true;
}

std::string VertexUse::unused(double share, std::size_t least) const {
  const std::string of_all = unused_from(0, share, least);
  return of_all.empty() ? unused_from(last_object_, share, least) : of_all;
}

std::string VertexUse::unused_from(std::size_t first, double share, std::size_t least) const {
  const auto begin = is_used_.begin() + static_cast<std::ptrdiff_t>(first);
  const auto count = static_cast<std::size_t>(std::count(begin, is_used_.end(), false));
  const std::size_t all = is_used_.size() - first;
  if (count < least || static_cast<double>(count) <= share * static_cast<double>(all)) return {};
  return std::to_string(count) + " of " + (first > 0 ? "the last " : "") + std::to_string(all) +
         (all == 1 ? " vertex" : " vertices") + (count == 1 ? " belongs" : " belong") + " to no face";
}

LastCorner::LastCorner(const std::uint32_t* face, std::size_t corners, std::size_t vertices,
                       std::uint32_t first)
    : corner_(face[corners - 1]),
      before_(face[corners - 2]),
      after_(face[0]),
      vertices_(vertices),
      first_(first) {}

void LastCorner::add(const std::uint32_t* face, std::size_t corners) {
  for (std::size_t i = 0; i < corners; ++i) {
    const std::uint32_t from = face[i], to = face[i + 1 < corners ? i + 1 : 0];
    note(from, to);
    note(to, from);
    is_known_ = is_known_ || from == corner_;
  }
}

void LastCorner::note(std::uint32_t from, std::uint32_t to) {
  if (from == before_) beside_before_.push_back(to);
  if (from == after_) beside_after_.push_back(to);
}

bool LastCorner::fits_longer() const {
  if (holds(beside_before_, corner_) || holds(beside_after_, corner_)) return false;
  const std::uint64_t number = corner_ + first_;
  std::vector<std::uint32_t> after = beside_after_;
  std::sort(after.begin(), after.end());
  // 3: 30 to 39, 300 to 399, and so on.
  for (std::uint64_t ten = 10; number > 0 && number * ten < vertices_ + first_; ten *= 10) {
    const auto is_longer = [&](std::uint32_t corner) { return (corner + first_) / ten == number; };
    for (const std::uint32_t corner : beside_before_) {
      if (is_longer(corner) && (is_known_ || std::binary_search(after.begin(), after.end(), corner)))
        return true;
    }
    if (is_known_ && std::any_of(beside_after_.begin(), beside_after_.end(), is_longer)) return true;
  }
  return false;
}

void LastCorner::check(std::size_t line) const {
  if (fits_longer())
    refuse_cut("its last line, line " + std::to_string(line) +
               ", has no line end, and its last corner, vertex " + std::to_string(corner_ + first_) +
               ", shares no edge with another face, as vertices with a longer number do");
}

}  // namespace tumblesight::sim
