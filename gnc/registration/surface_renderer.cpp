#include "gnc/registration/surface_renderer.hpp"

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"
#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {
namespace {

// From the middle of the screen to either side; what lies farther out is not drawn. Products of two
// differences fit into 32 bits.
constexpr std::int32_t kFarthest = RangeImage::kMaxRays * kScreenRay;
constexpr int kMaxWork = 3 << 14;  // rays and rows of all triangles together

// What takes a point of the target to the screen, in 32 bits.
class Camera {
 public:
  Camera(const FrameView& view, const Pose& pose)
      : turn_(pose.r_lrf_trf), middle_(view.rays * (kScreenRay / 2)), nearness_shift_(28 - view.shift) {
    constexpr std::int64_t kMost_um = 1'000'000'000, kOneQ29 = std::int64_t{1} << 29;
    std::array<std::int64_t, 3> origin_um{};
    for (std::size_t i = 0; i < 3; ++i)
      origin_um[i] = clamp<std::int64_t>(pose.origin_lrf_um[i], -kMost_um, kMost_um);
    depth_q29_ = static_cast<std::int32_t>(
        clamp(divide(origin_um[1] * kOneQ29, view.reference_depth_um), -3 * kOneQ29, 3 * kOneQ29));
    depth_per_radius_q31_ = 2 * view.radius_over_depth_q30;
    // 1/64 ray per slope, below 2^19, and of the origin and a radius times their depth.
    const std::int64_t per_slope_q10 = divide(std::int64_t{middle_} << 40, view.tan_half_fov_q30);
    const std::int64_t per_radius_q20 = (view.radius_over_depth_q30 * per_slope_q10) >> 20;
    constexpr std::int64_t kMostOffset_q10 = std::int64_t{1} << 35;  // far outside of every screen
    const auto offset_q10 = [&](std::int64_t at_um) {
      return clamp(divide(at_um * per_slope_q10, view.reference_depth_um), -kMostOffset_q10, kMostOffset_q10);
    };
    const std::int64_t right_q10 = offset_q10(origin_um[0]), up_q10 = offset_q10(origin_um[2]);
    const std::int64_t most_q10 = max(abs(right_q10), abs(up_q10)) + (per_radius_q20 >> 9);
    // As many fraction bits as keep a point's offset below 2^30.
    bits_ = clamp(39 - highest_bit(static_cast<std::uint64_t>(most_q10)), 4, 18);
    right_ = static_cast<std::int32_t>((right_q10 * (1 << bits_)) >> 10);
    up_ = static_cast<std::int32_t>((up_q10 * (1 << bits_)) >> 10);
    screen_per_radius_ = static_cast<std::int32_t>((per_radius_q20 << bits_) >> 18);
  }

  ScreenPoint project(const SurfaceMesh::Vertex& vertex) const {
    ScreenPoint point{ScreenPoint::kOutside, 0, 0};
    // Depths over the reference depth. Q29 leaves room for those that are not drawn.
    const std::int32_t depth_q29 =
        depth_q29_ + high_product(turn_.element_q30(1, vertex), depth_per_radius_q31_);
    if (depth_q29 < (1 << 27) || depth_q29 >= (1 << 30)) return point;
    const std::int32_t inverse_q28 = reciprocal_q28(2 * depth_q29);
    const int bits = bits_ - 4;
    const std::int32_t half = (1 << bits) >> 1;
    const auto on_screen = [&](std::int32_t origin, std::size_t element) {
      const std::int32_t offset =
          origin + high_product(turn_.element_q30(element, vertex), screen_per_radius_);
      return (high_product(offset, inverse_q28) + half) >> bits;
    };
    const std::int32_t right = on_screen(right_, 0), up = on_screen(up_, 2);
    if (right > kFarthest || right < -kFarthest || up > kFarthest || up < -kFarthest) return point;
    point.column = static_cast<std::int16_t>(middle_ + right);
    point.row = static_cast<std::int16_t>(middle_ - up);
    const std::int32_t nearness = (inverse_q28 - (1 << 28)) >> nearness_shift_;
    point.nearness = static_cast<std::int16_t>(min_small(max_small(nearness, -32'767), 32'767));
    return point;
  }

 private:
  Turn turn_;
  std::int32_t depth_q29_ = 0, depth_per_radius_q31_ = 0;  // over the reference depth
  // On the screen in 1/64 of a ray, times the depth, with bits_ fraction bits; per radius with two more.
  std::int32_t right_ = 0, up_ = 0, screen_per_radius_ = 0;
  int bits_ = 0;
  std::int32_t middle_;  // of the screen
  int nearness_shift_;
};

// First ray whose middle is at `coordinate` or after it, and last one at it or before it.
int first_ray(std::int32_t coordinate) {
  return (coordinate + kScreenRay / 2 - 1) >> kScreenBits;
}
int last_ray(std::int32_t coordinate) {
  return (coordinate - kScreenRay / 2) >> kScreenBits;
}

struct Bounds {
  int first, last;
  bool is_empty() const { return first > last; }
};
inline Bounds bounds(std::int32_t a, std::int32_t b, std::int32_t c, int rays) {
  return {max_small(0, first_ray(min_small(a, min_small(b, c)))),
          min_small(rays - 1, last_ray(max_small(a, max_small(b, c))))};
}

// Where an edge crosses the middles of the rows, with kBits fraction bits.
class Crossing {
 public:
  static constexpr int kBits = 14;
  static constexpr std::int32_t kOne = 1 << kBits;

  // `a` above `b`; `row`: the first one.
  Crossing(const ScreenPoint& a, const ScreenPoint& b, int row) {
    const std::int32_t down = b.row - a.row;
    const std::int32_t slope = down == 0 ? 0 : ((b.column - a.column) * kOne) / down;  // per 1/64 of a ray
    column_ = a.column * kOne + slope * (row * kScreenRay + kScreenRay / 2 - a.row);
    // An edge that is less high crosses one row at most.
    per_row_ = down < kScreenRay ? 0 : slope * kScreenRay;
  }
  std::int32_t column() const { return column_; }
  void next_row() { column_ += per_row_; }

 private:
  std::int32_t column_, per_row_;
};

// The nearness of a triangle's plane, in 1/256.
struct Plane {
  std::int32_t at_first;  // at the middle of the first ray of `rows` and `columns`
  std::int32_t per_column, per_row;
  std::int32_t lowest, highest;  // of the corners, in whole numbers
};
Plane plane_of(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c, std::int32_t whole,
               const Bounds& rows, const Bounds& columns) {
  const std::int32_t to_b = b.nearness - a.nearness, to_c = c.nearness - a.nearness;
  // 1 / whole, by a reciprocal of the number with 30 bits.
  const int shift = 29 - highest_bit_32(static_cast<std::uint32_t>(whole));
  const std::int32_t inverse_q28 = reciprocal_q28(whole * (1 << shift));
  // * 64 * 256 / whole; the halves keep the difference within 32 bits.
  const auto per_ray = [&](std::int32_t first, std::int32_t second) -> std::int32_t {
    constexpr std::int32_t kLargest = 1 << 22;
    const std::int32_t half = (first >> 1) - (second >> 1);
    if ((half >> 7) >= whole) return kLargest;
    if ((half >> 7) < -whole) return -kLargest;
    const std::int32_t scaled = shift >= 7 ? half * (1 << (shift - 7)) : half >> (7 - shift);
    return high_product(scaled, inverse_q28) >> 4;
  };
  Plane plane{};
  plane.per_column = per_ray(to_b * (c.row - a.row), to_c * (b.row - a.row));
  plane.per_row = per_ray(to_c * (b.column - a.column), to_b * (c.column - a.column));
  const std::int32_t right = columns.first * kScreenRay + kScreenRay / 2 - a.column;
  const std::int32_t down = rows.first * kScreenRay + kScreenRay / 2 - a.row;
  constexpr std::int64_t kMost = 1 << 29;
  const std::int64_t from_a =
      (std::int64_t{plane.per_column} * right + std::int64_t{plane.per_row} * down) >> kScreenBits;
  plane.at_first = a.nearness * 256 + 128 + static_cast<std::int32_t>(clamp(from_a, -kMost, kMost));
  plane.lowest = min_small(a.nearness, min_small(b.nearness, c.nearness));
  plane.highest = max_small(a.nearness, max_small(b.nearness, c.nearness));
  return plane;
}

// Rays of one row, from `first` to `last`.
void fill_row(int row, int first, int last, std::int32_t nearness, const Plane& plane,
              RenderedSurface& surface) {
  std::int16_t* out = &surface.nearness[row * surface.rays + first];
  for (int column = first; column <= last; ++column, ++out, nearness += plane.per_column) {
    std::int32_t here = nearness >> 8;
    if (here < plane.lowest) here = plane.lowest;
    if (here > plane.highest) here = plane.highest;
    if (here > *out) *out = static_cast<std::int16_t>(here);
  }
  RayMask::Row& filled = surface.filled.rows[static_cast<std::size_t>(row)];
  const int first_word = first / RayMask::kColumnsPerWord, last_word = last / RayMask::kColumnsPerWord;
  std::uint32_t from_first = ~std::uint32_t{0} >> (first % RayMask::kColumnsPerWord);
  for (int word = first_word; word < last_word; ++word, from_first = ~std::uint32_t{0})
    filled[static_cast<std::size_t>(word)] |= from_first;
  filled[static_cast<std::size_t>(last_word)] |=
      from_first & (~std::uint32_t{0} << (RayMask::kColumnsPerWord - 1 - last % RayMask::kColumnsPerWord));
}

void clear(RenderedSurface& surface) {
  // Eight at a time, which compilers make one or two stores of.
  constexpr std::size_t kAtATime = 8;
  static_assert(RangeImage::kMaxReturns % kAtATime == 0);
  for (std::size_t first = 0; first < surface.nearness.size(); first += kAtATime)
#pragma GCC unroll 8
    for (std::size_t i = 0; i < kAtATime; ++i) surface.nearness[first + i] = RenderedSurface::kEmpty;
  for (RayMask::Row& row : surface.filled.rows) row = {};
}

// Draws one triangle with area(a, b, c) > 0; returns the work done.
int draw(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c, std::int32_t whole,
         const Bounds& rows, const Bounds& columns, RenderedSurface& surface) {
  // The corners from top to bottom. The long edge joins the first and the last one.
  const ScreenPoint *top = &a, *middle = &b, *bottom = &c;
  bool is_long_edge_left = false;
  const auto exchange = [&](const ScreenPoint*& p, const ScreenPoint*& q) {
    const ScreenPoint* const kept = p;
    p = q;
    q = kept;
    is_long_edge_left = !is_long_edge_left;
  };
  if (top->row > middle->row) exchange(top, middle);
  if (middle->row > bottom->row) exchange(middle, bottom);
  if (top->row > middle->row) exchange(top, middle);
  // To the right of the way down a triangle with positive area has its corners in turn.
  is_long_edge_left = !is_long_edge_left;

  Crossing long_edge(*top, *bottom, rows.first);
  // Rows with their middle above the middle corner or, unless the upper edge is level, at it.
  const int bend = top->row == middle->row
                       ? rows.first
                       : max_small(rows.first, min_small(rows.last, last_ray(middle->row)) + 1);
  Plane plane{};
  int covered = 0;
  const auto fill = [&](Crossing short_edge, int from, int to) {
    for (int row = from; row <= to; ++row) {
      const std::int32_t left = is_long_edge_left ? long_edge.column() : short_edge.column();
      const std::int32_t right = is_long_edge_left ? short_edge.column() : long_edge.column();
      long_edge.next_row();
      short_edge.next_row();
      constexpr std::int32_t kHalf = Crossing::kOne * kScreenRay / 2;
      const int first = max_small(columns.first, (left + kHalf - 1) >> (Crossing::kBits + kScreenBits));
      const int last = min_small(columns.last, (right - kHalf) >> (Crossing::kBits + kScreenBits));
      if (first > last) continue;
      // Many triangles lie between the rays and need no plane.
      if (covered == 0) plane = plane_of(a, b, c, whole, rows, columns);
      const std::int32_t nearness =
          plane.at_first + plane.per_row * (row - rows.first) + plane.per_column * (first - columns.first);
      fill_row(row, first, last, nearness, plane, surface);
      covered += last - first + 1;
    }
  };
  if (bend > rows.first) fill(Crossing(*top, *middle, rows.first), rows.first, bend - 1);
  if (bend <= rows.last) fill(Crossing(*middle, *bottom, bend), bend, rows.last);
  return covered + rows.last - rows.first + 1;
}

}  // namespace

Turn::Turn(const Matrix3<Fixed>& r_lrf_trf) {
  for (int i = 0; i < 9; ++i) {
    // An element of a rotation; a larger one is limited.
    constexpr std::int32_t kOne = 1 << Fixed::kFractionBits;
    const std::int32_t element = clamp(r_lrf_trf(i / 3, i % 3).raw(), -kOne, kOne);
    r_q15_[static_cast<std::size_t>(i)] = (element + (1 << 8)) >> 9;
  }
}

void render(const SurfaceMesh& mesh, const FrameView& view, const Pose& pose, RenderedSurface& surface) {
  surface.rays = view.rays;
  surface.is_complete = true;
  clear(surface);
  const Camera camera(view, pose);
  ScreenVertices& vertices = *surface.vertices;
  bool all_inside = true;
  for (int i = 0; i < mesh.vertices(); ++i) {
    ScreenPoint& point = vertices[static_cast<std::size_t>(i)];
    point = camera.project(mesh.vertex(i));
    all_inside = all_inside && !point.is_outside();
  }
  int work = 0;
  for (int i = 0; i < mesh.triangles(); ++i) {
    const SurfaceMesh::Triangle triangle = mesh.triangle(i);
    // The image was sound when it was loaded, but its memory may have been damaged since.
    if (!mesh.has(triangle[0], triangle[1], triangle[2])) continue;
    const ScreenPoint& a = vertices[triangle[0]];
    const ScreenPoint &b = vertices[triangle[1]], &c = vertices[triangle[2]];
    if (!all_inside && (a.is_outside() || b.is_outside() || c.is_outside())) {
      surface.is_complete = false;
      continue;
    }
    // Its corners run counterclockwise if it shows its front.
    const std::int32_t whole = area(a, c, b);
    if (whole <= 0) continue;
    const Bounds rows = bounds(a.row, b.row, c.row, view.rays);
    if (rows.is_empty()) continue;
    const Bounds columns = bounds(a.column, b.column, c.column, view.rays);
    if (columns.is_empty()) continue;
    if (work > kMaxWork) {
      surface.is_complete = false;
      break;
    }
    work += draw(a, c, b, whole, rows, columns, surface);
  }
}

}  // namespace tumblesight::gnc
