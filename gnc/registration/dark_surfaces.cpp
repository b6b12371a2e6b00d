#include "gnc/registration/dark_surfaces.hpp"

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"
#include "gnc/numerics/select.hpp"
#include "gnc/registration/triangle_spans.hpp"

namespace tumblesight::gnc {
namespace {

// A triangle is judged by its own rays if so many of them would return, were it bright. So is an angle of
// incidence.
constexpr std::int64_t kLeastExpected = 6;
// Dark: fewer than one ray of so many return, and fewer than half as many as of bright ones.
constexpr std::int64_t kRaysPerReturn = 5, kHalf = 2;

constexpr int kAngles = DarkSurfaces::kAngles;
// Squared tangents of the angles of incidence between the classes, Q8: every 6 degrees.
constexpr std::array<std::int32_t, kAngles - 1> kTangentSquared_q8{3,   12,  27,  51,   85,   135,  208,
                                                                   316, 485, 768, 1291, 2425, 5666, 23174};

bool return_as_much(const RayCount& rays, const RayCount& all) {
  return rays.returned * all.drawn >= rays.drawn * all.returned;
}
bool are_enough(const RayCount& rays, const RayCount& bright) {
  return rays.drawn * bright.returned >= kLeastExpected * bright.drawn;
}
bool are_dark(const RayCount& rays, const RayCount& bright) {
  return rays.returned * kRaysPerReturn < rays.drawn &&
         kHalf * rays.returned * bright.drawn < rays.drawn * bright.returned;
}

// That the target covers, without hidden ones.
RayCount all_rays(const FrameView& view, const RenderedSurface& surface) {
  RayCount all;
  for (std::size_t row = 0; row < static_cast<std::size_t>(view.rays); ++row) {
    for (std::size_t word = 0; word < RayMask::kWordsPerRow; ++word) {
      const std::uint32_t drawn = surface.filled.rows[row][word] & ~view.hidden.rows[row][word];
      all.drawn += count_ones(drawn);
      all.returned += count_ones(drawn & view.returned.rows[row][word]);
    }
  }
  return all;
}

// Whether a triangle is the nearest one at a ray: it wrote the inverse depth that is there.
bool is_nearest(const RenderedSurface& surface, int row, int column, std::int32_t inverse_depth,
                const Plane& plane) {
  const std::int32_t here = min_small(max_small(inverse_depth >> 8, plane.lowest), plane.highest);
  return here == surface.inverse_depth[row * surface.rays + column];
}

// Counts the rays of a triangle that nothing nearer covers, and keeps its plane. A visitor of visit_spans().
class Counter {
 public:
  Counter(const FrameView& view, const RenderedSurface& surface) : view_(view), surface_(surface) {}
  void operator()(int row, int first, int last, std::int32_t inverse_depth, const Plane& plane) {
    if (rays_.drawn == 0) {
      row_ = row;
      column_ = first;
      inverse_depth_ = inverse_depth;
      per_column_ = plane.per_column;
      per_row_ = plane.per_row;
    }
    for (int column = first; column <= last; ++column, inverse_depth += plane.per_column) {
      if (!is_nearest(surface_, row, column, inverse_depth, plane) || view_.is_hidden(row, column)) continue;
      ++rays_.drawn;
      rays_.returned += view_.is_returned(row, column) ? 1 : 0;
    }
  }
  const RayCount& rays() const { return rays_; }

  // The class of the angle of incidence. 0: the triangle faces the sensor. `slope_per_half_ray_q24`: of the
  // screen.
  std::size_t angle(std::int32_t slope_per_half_ray_q24) const {
    // The plane's inverse depth + 2^shift is (depth + right slope + up slope) times the reference depth per
    // radius. So (right, depth, up) is along its normal, and the sum its product with the ray's direction.
    constexpr std::int64_t kMost = 1 << 21;
    const auto per_slope = [&](std::int32_t per_ray) {
      return clamp((std::int64_t{per_ray} * view_.rays_per_radius_q8) >> 16, -kMost, kMost);
    };
    const auto slope_q14 = [&](int at) {
      return (std::int64_t{2 * at + 1 - view_.rays} * slope_per_half_ray_q24) >> 10;
    };
    const std::int64_t right = per_slope(per_column_), down = per_slope(per_row_);
    const std::int64_t right_q14 = slope_q14(column_), down_q14 = slope_q14(row_);
    const std::int64_t whole = (std::int64_t{1} << view_.shift) + (inverse_depth_ >> 8);
    const std::int64_t along = (whole * view_.radius_over_depth_q30) >> 30;
    const std::int64_t depth = along - ((right * right_q14 + down * down_q14) >> 14);
    const std::int64_t normal_squared = right * right + down * down + depth * depth;
    const std::int64_t ray_squared_q14 = (1 << 14) + ((right_q14 * right_q14 + down_q14 * down_q14) >> 14);
    const std::int64_t along_squared = along * along;
    const std::int64_t across_squared_q8 = ((normal_squared * ray_squared_q14) >> 6) - along_squared * 256;
    std::size_t angle = 0;
    for (const std::int32_t limit : kTangentSquared_q8)
      angle += across_squared_q8 > along_squared * limit ? 1U : 0U;
    return angle;
  }

 private:
  const FrameView& view_;
  const RenderedSurface& surface_;
  RayCount rays_;
  int row_ = 0, column_ = 0;  // of the first ray
  std::int32_t inverse_depth_ = 0, per_column_ = 0, per_row_ = 0;
};

std::int32_t slope_per_half_ray_q24(const FrameView& view) {
  return static_cast<std::int32_t>(divide(view.tan_half_fov_q30, view.rays) >> 6);
}

// Moves the rays of a triangle to the dark ones. A visitor of visit_spans().
class Remover {
 public:
  explicit Remover(RenderedSurface& surface) : surface_(surface) {}
  void operator()(int row, int first, int last, std::int32_t inverse_depth, const Plane& plane) {
    const auto at = static_cast<std::size_t>(row);
    for (int column = first; column <= last; ++column, inverse_depth += plane.per_column) {
      if (!is_nearest(surface_, row, column, inverse_depth, plane)) continue;
      const auto word = static_cast<std::size_t>(column / RayMask::kColumnsPerWord);
      const std::uint32_t ray = 0x8000'0000U >> (column % RayMask::kColumnsPerWord);
      surface_.filled.rows[at][word] &= ~ray;
      surface_.dark.rows[at][word] |= ray;
    }
  }

 private:
  RenderedSurface& surface_;
};

// A bit for each angle of incidence at which few rays return.
std::uint32_t dark_angles_of(const DarkSurfaces& dark) {
  std::uint32_t dark_angles = 0;
  for (std::size_t angle = 0; angle < dark.of_angle.size(); ++angle) {
    const RayCount& rays = dark.of_angle[angle];
    if (are_enough(rays, dark.bright) && are_dark(rays, dark.bright)) dark_angles |= 1U << angle;
  }
  return dark_angles;
}

// Counts the rays of all triangles of `surface` into `dark`. `bright` and `dark_angles`: by which a triangle
// is judged. `takes_out`: the same surface if what is dark is taken out, or null. It ends with the budget.
void look_at_triangles(const SurfaceMesh& mesh, const FrameView& view, const RenderedSurface& surface,
                       const RayCount& bright, std::uint32_t dark_angles, DarkSurfaces& dark,
                       RenderedSurface* takes_out, WorkBudget& budget) {
  if (!budget.spend(work::kDarkLook)) return;
  const RayCount all = all_rays(view, surface);
  const std::int32_t slope_q24 = slope_per_half_ray_q24(view);
  const auto look = [&](const ScreenTriangle& triangle) {
    Counter counter(view, surface);
    const int covered = visit_spans(triangle, counter);  // rays
    if (!budget.spend(work::kDarkTriangle + triangle.height() * work::kDarkRow + covered * work::kDarkRay))
      return false;
    const RayCount& rays = counter.rays();
    if (rays.drawn == 0) return true;
    budget.spend(work::kDarkSeen);
    if (return_as_much(rays, all)) dark.bright.add(rays);
    bool is_dark = are_dark(rays, bright);
    const bool is_alone = are_enough(rays, bright);
    if (!is_alone) {
      budget.spend(work::kDarkAngle);
      const std::size_t angle = counter.angle(slope_q24);
      dark.of_angle[angle].add(rays);
      is_dark = ((dark_angles >> angle) & 1U) != 0;
    }
    if (takes_out == nullptr || !is_dark) return true;
    dark.surfaces += is_alone ? 1 : 0;
    visit_spans(triangle, Remover(*takes_out));
    return budget.spend(work::kTakenOut + triangle.height() * work::kTakenRow + covered * work::kTakenRay);
  };
  int first = 0;
  for (const std::uint32_t word : surface.covering.words) {
    int i = first;
    for (std::uint32_t covering = word; covering != 0 && i < mesh.triangles(); covering >>= 1, ++i) {
      if ((covering & 1U) == 0) continue;
      // All corners are on the screen, unless memory has been damaged since the triangle was drawn.
      if (visit_front(mesh, i, view.rays, *surface.vertices, false, look) == Visited::kStop) return;
    }
    first += TriangleSet::kPerWord;
  }
}

}  // namespace

void measure_brightness(const SurfaceMesh& mesh, const FrameView& view, const RenderedSurface& surface,
                        DarkSurfaces& dark, WorkBudget& budget) {
  dark = {};
  if (surface.is_complete)
    look_at_triangles(mesh, view, surface, all_rays(view, surface), 0, dark, nullptr, budget);
}

void take_out_dark_surfaces(const SurfaceMesh& mesh, const FrameView& view, DarkSurfaces& dark,
                            RenderedSurface& surface, WorkBudget& budget) {
  const RayCount bright = dark.bright;
  const std::uint32_t dark_angles = dark_angles_of(dark);
  dark = {};
  if (!surface.is_complete) return;
  dark.surfaces = count_ones(dark_angles);
  look_at_triangles(mesh, view, surface, bright, dark_angles, dark, &surface, budget);
  surface.has_dark = dark.surfaces > 0;
}

}  // namespace tumblesight::gnc
