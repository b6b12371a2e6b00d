#include "gnc/registration/surface_renderer.hpp"

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"
#include "gnc/numerics/select.hpp"
#include "gnc/registration/reciprocal.hpp"
#include "gnc/registration/triangle_spans.hpp"

namespace tumblesight::gnc {
namespace {

// From the middle of the screen to either side; what lies farther out is not drawn. Products of two
// differences fit into 32 bits.
constexpr std::int32_t kFarthest = RangeImage::kMaxRays * kScreenRay;
constexpr int kMostDrawn = 3 << 14;  // rays and rows of all triangles together

// What takes a point of the target to the screen, in 32 bits.
class Camera {
 public:
  Camera(const FrameView& view, const Pose& pose)
      : turn_(pose.r_lrf_trf), middle_(view.rays * (kScreenRay / 2)), inverse_depth_shift_(28 - view.shift) {
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
    const std::int32_t inverse_depth = (inverse_q28 - (1 << 28)) >> inverse_depth_shift_;
    point.inverse_depth = static_cast<std::int16_t>(min_small(max_small(inverse_depth, -32'767), 32'767));
    return point;
  }

 private:
  Turn turn_;
  std::int32_t depth_q29_ = 0, depth_per_radius_q31_ = 0;  // over the reference depth
  // On the screen in 1/64 of a ray, times the depth, with bits_ fraction bits; per radius with two more.
  std::int32_t right_ = 0, up_ = 0, screen_per_radius_ = 0;
  int bits_ = 0;
  std::int32_t middle_;  // of the screen
  int inverse_depth_shift_;
};

// Rays of one row, from `first` to `last`.
void fill_row(int row, int first, int last, std::int32_t inverse_depth, const Plane& plane,
              RenderedSurface& surface) {
  std::int16_t* out = &surface.inverse_depth[row * surface.rays + first];
  for (int column = first; column <= last; ++column, ++out, inverse_depth += plane.per_column) {
    std::int32_t here = inverse_depth >> 8;
    if (here < plane.lowest) here = plane.lowest;
    if (here > plane.highest) here = plane.highest;
    if (here > *out) *out = static_cast<std::int16_t>(here);
  }
  RayMask::Row& filled = surface.filled.rows[static_cast<std::size_t>(row)];
  constexpr unsigned kPerWord = RayMask::kColumnsPerWord;
  const auto from = static_cast<unsigned>(first), to = static_cast<unsigned>(last);
  std::uint32_t from_first = ~std::uint32_t{0} >> (from % kPerWord);
  for (unsigned word = from / kPerWord; word < to / kPerWord; ++word, from_first = ~std::uint32_t{0})
    filled[word] |= from_first;
  filled[to / kPerWord] |= from_first & (~std::uint32_t{0} << (kPerWord - 1 - to % kPerWord));
}

void clear(RenderedSurface& surface) {
  // Eight at a time, which compilers make one or two stores of.
  constexpr std::size_t kAtATime = 8;
  static_assert(RangeImage::kMaxReturns % kAtATime == 0);
  for (std::size_t first = 0; first < surface.inverse_depth.size(); first += kAtATime)
#pragma GCC unroll 8
    for (std::size_t i = 0; i < kAtATime; ++i) surface.inverse_depth[first + i] = RenderedSurface::kEmpty;
  surface.filled = {};
  surface.dark = {};
  surface.covering = {};
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

void render(const SurfaceMesh& mesh, const FrameView& view, const Pose& pose, RenderedSurface& surface,
            WorkBudget& budget) {
  surface.rays = view.rays;
  surface.has_dark = false;
  clear(surface);
  surface.is_complete =
      budget.spend(work::kDrawing + mesh.vertices() * work::kVertex + mesh.triangles() * work::kTriangle);
  if (!surface.is_complete) return;
  const Camera camera(view, pose);
  ScreenVertices& vertices = *surface.vertices;
  bool all_inside = true;
  for (int i = 0; i < mesh.vertices(); ++i) {
    ScreenPoint& point = vertices[static_cast<std::size_t>(i)];
    point = camera.project(mesh.vertex(i));
    all_inside = all_inside && !point.is_outside();
  }
  int drawn = 0;
  const auto draw = [&](const ScreenTriangle& triangle) {
    if (drawn > kMostDrawn) return false;
    const int covered = visit_spans(
        triangle, [&](int row, int first, int last, std::int32_t inverse_depth, const Plane& plane) {
          fill_row(row, first, last, inverse_depth, plane, surface);
        });
    if (covered > 0) surface.covering.add(static_cast<unsigned>(triangle.index));
    drawn += covered + triangle.height();
    const std::int32_t plane = covered > 0 ? work::kCovering : 0;
    return budget.spend(work::kFront + plane + triangle.height() * work::kRow + covered * work::kRay);
  };
  for (int i = 0; i < mesh.triangles(); ++i) {
    const Visited visited = visit_front(mesh, i, view.rays, vertices, all_inside, draw);
    if (visited == Visited::kGoOn) continue;
    surface.is_complete = false;
    if (visited == Visited::kStop) return;
  }
}

}  // namespace tumblesight::gnc
