#include "gnc/registration/silhouette_fit.hpp"

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"
#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kMaxAcross = 12;  // rays to either side of the silhouette
// Beside which nothing is drawn, and as many between dark and bright surfaces.
constexpr int kMaxPlaces = 6144;
constexpr int kMostPerRow = 4;  // places that share a row of the equations
constexpr std::uint32_t kLeastFill_q16 = 32'768, kWholeFill_q16 = 64'880;  // 1/2 and 99 %
constexpr std::int32_t kBehind_um = 250'000;  // an edge this far behind another surface is hidden

// 1 / sqrt(1 + t^2) in Q14, by t in 64ths, from 0 to 1.
constexpr std::array<std::int32_t, 66> kCosine_q14 = [] {
  std::array<std::int32_t, 66> cosine{};
  for (std::int64_t i = 0; i < 66; ++i) {
    const std::int64_t square_q40 = (std::int64_t{1} << 52) / (4096 + i * i);
    std::int64_t root_q20 = 0;
    for (std::int64_t bit = 1 << 20; bit > 0; bit /= 2)
      if ((root_q20 + bit) * (root_q20 + bit) <= square_q40) root_q20 += bit;
    cosine[static_cast<std::size_t>(i)] = static_cast<std::int32_t>((root_q20 + 32) >> 6);
  }
  return cosine;
}();
// t_q14: 0 to 1.
std::int32_t cosine_q14(std::int32_t t_q14) {
  const auto at = static_cast<std::size_t>(t_q14 >> 8);
  return kCosine_q14[at] + (((kCosine_q14[at + 1] - kCosine_q14[at]) * (t_q14 & 0xFF)) >> 8);
}

struct Rays {
  std::int32_t derivative = 0;   // Q12 / sigma
  std::int32_t information = 0;  // Q12 / sigma^2
};

// An edge that may be on the silhouette, in the direction in which it is followed: from row to row if it is
// steep, else from column to column. `line`: that row or column; `across`: the other coordinate.
struct SilhouetteEdge {
  bool is_steep;
  const ScreenPoint &from, &to;  // `line` grows
  int from_vertex, to_vertex;
  int outward;  // 1 or -1: the direction of `across` that leads out of the target

  std::int32_t line(const ScreenPoint& point) const { return is_steep ? point.row : point.column; }
  std::int32_t across(const ScreenPoint& point) const { return is_steep ? point.column : point.row; }
};

// The rays of one line on both sides of the silhouette.
class Across {
 public:
  Across(const FrameView& view, const RenderedSurface& surface, const SilhouetteTable& table,
         std::int32_t sigma_q8)
      : view_(view),
        surface_(surface),
        table_(table),
        reach_((3 * sigma_q8) / (256 / kScreenRay) + kScreenRay),
        steps_per_distance_q16_((SilhouetteTable::kPerSigma << 24) / (sigma_q8 * kScreenRay)),
        behind_(static_cast<std::int32_t>(
            divide(std::int64_t{kBehind_um} << view.shift, view.reference_depth_um))) {}

  // On which side of an edge between two triangles nothing returns: 1 or -1 as SilhouetteEdge::outward, 0 if
  // both sides are dark or bright, or something nearer hides them. Its middle decides. An edge next to one
  // beside which nothing is drawn counts, too: the silhouette is trusted more where surfaces are dark
  // (docs/numerics.md).
  int dark_side(const SilhouetteEdge& edge) const {
    const Line at{edge.is_steep, (edge.line(edge.from) + edge.line(edge.to)) >> (kScreenBits + 1),
                  view_.rays};
    const int across = (edge.across(edge.from) + edge.across(edge.to)) >> (kScreenBits + 1);
    const bool is_before = is_filled(at, across - 1), is_after = is_filled(at, across + 1);
    if (is_before == is_after) return 0;
    const std::int32_t inverse_depth = (edge.from.inverse_depth + edge.to.inverse_depth) >> 1;
    const int bright = is_before ? across - 1 : across + 1;
    if (surface_.inverse_depth[at.ray(bright)] > inverse_depth + behind_) return 0;
    return is_before ? 1 : -1;
  }

  // The whole look, in three parts: the rays next to the silhouette must agree with it, then outwards and
  // inwards until the rendering changes. `place`: where the silhouette crosses the line, in 1/64 of a ray;
  // `cosine_q14`: of its angle to the perpendicular of the line. `looked_at` grows by the rays.
  bool look_across(const SilhouetteEdge& edge, int line, std::int32_t place, std::int32_t inverse_depth,
                   std::int32_t cosine_q14, Rays& rays, int& looked_at) const {
    const Line at{edge.is_steep, line, view_.rays};
    const int outer = edge.outward > 0 ? first_ray(place) : last_ray(place);
    const int inner = outer - edge.outward;
    if (inner < 0 || inner >= view_.rays) return false;
    const std::int32_t from_place = (outer * kScreenRay + kScreenRay / 2 - place) * edge.outward;
    const std::int32_t outer_distance = (from_place * cosine_q14) >> 14;
    const std::int32_t step = (kScreenRay * cosine_q14) >> 14;
    const std::int32_t inner_distance = outer_distance - step;
    const bool is_inner_filled = is_filled(at, inner);
    const bool is_contradicted = (!is_inner_filled && inner_distance < -2) ||
                                 (outer_distance > 2 && is_filled(at, outer)) ||
                                 is_filled(at, outer + edge.outward);
    if (is_contradicted) return false;
    if (is_inner_filled && surface_.inverse_depth[at.ray(inner)] > inverse_depth + behind_) return false;
    rays = {};
    std::int32_t distance = outer_distance;
    for (int k = 0; k < kMaxAcross && distance <= reach_; ++k, ++looked_at, distance += step) {
      const int ray = outer + k * edge.outward;
      if (ray < 0 || ray >= view_.rays || (k > 1 && is_filled(at, ray))) break;
      if (!add(at, ray, distance, rays)) return false;
    }
    distance = inner_distance;
    for (int k = 0; k < kMaxAcross && distance >= -reach_; ++k, ++looked_at, distance -= step) {
      const int ray = inner - k * edge.outward;
      if (ray < 0 || ray >= view_.rays || (k > 0 && !is_filled(at, ray))) break;
      if (!add(at, ray, distance, rays)) return false;
    }
    return true;
  }

 private:
  struct Line {
    bool is_row;
    int number, rays;
    std::size_t ray(int across) const {
      return static_cast<std::size_t>(is_row ? number * rays + across : across * rays + number);
    }
  };
  bool is_filled(const Line& line, int across) const {
    return line.is_row ? surface_.is_filled(line.number, across) : surface_.is_filled(across, line.number);
  }
  // A ray at `distance` outside the silhouette, in 1/64 of a ray. False: it is hidden.
  bool add(const Line& line, int across, std::int32_t distance, Rays& rays) const {
    const int row = line.is_row ? line.number : across, column = line.is_row ? across : line.number;
    if (view_.is_hidden(row, column)) return false;
    constexpr int kMiddle = SilhouetteTable::kSteps / 2;
    const int step = kMiddle + ((distance * steps_per_distance_q16_ + (1 << 15)) >> 16);
    const auto at =
        static_cast<std::size_t>(min_small(max_small(step, 0), std::int32_t{SilhouetteTable::kSteps - 1}));
    rays.derivative += view_.is_returned(row, column) ? table_.if_hit[at] : table_.if_missed[at];
    rays.information += table_.information[at];
    return true;
  }

  const FrameView& view_;
  const RenderedSurface& surface_;
  const SilhouetteTable& table_;
  std::int32_t reach_;  // in 1/64 of a ray
  std::int32_t steps_per_distance_q16_;
  std::int32_t behind_;
};

// A point on an edge.
struct Place {
  std::int32_t column, row;          // in 1/64 of a ray
  std::int32_t out_right, out_down;  // the direction outwards, Q14
  std::int32_t inverse_depth;
};

// The row of the equations for a move of the silhouette outwards, per radius at the reference depth, Q14.
class SilhouetteRows {
 public:
  SilhouetteRows(const FrameView& view, const Pose& pose)
      : turn_(pose.r_lrf_trf), middle_(view.rays * (kScreenRay / 2)), shift_(view.shift) {
    slope_q30_ = static_cast<std::int32_t>(divide(view.tan_half_fov_q30, middle_));
  }
  std::array<std::int32_t, kUnknowns> row_of(const Place& place, const SurfaceMesh::Vertex& vertex) const {
    const auto slope_q14 = [&](std::int32_t from_middle) {
      return static_cast<std::int32_t>((std::int64_t{from_middle} * slope_q30_) >> 16);
    };
    const std::int32_t right = slope_q14(place.column - middle_), up = slope_q14(middle_ - place.row);
    const std::int32_t out_right = place.out_right, out_up = -place.out_down;
    const std::int32_t nearer =
        (1 << 14) + ((place.inverse_depth * (1 << 14)) >> shift_);  // reference depth / depth
    std::array<std::int32_t, 3> along{out_right, -((right * out_right + up * out_up) >> 14), out_up};
    for (std::int32_t& element : along) element = (element * nearer) >> 14;
    const Arm arm = turn_(vertex);
    const auto cross = [&](std::size_t i, std::size_t k) {
      return static_cast<std::int32_t>((std::int64_t{arm[i]} * along[k] - std::int64_t{arm[k]} * along[i]) >>
                                       15);
    };
    return {cross(1, 2), cross(2, 0), cross(0, 1), along[0], along[1], along[2]};
  }

 private:
  Turn turn_;
  std::int32_t middle_;
  int shift_;
  std::int32_t slope_q30_;  // per 1/64 of a ray
};

// The lines whose middles an edge crosses, of `every` line one.
struct Lines {
  int first, end;
  bool are_none() const { return first >= end; }
};
Lines lines_of(const SilhouetteEdge& edge, int every, int rays) {
  // Between the first end and before the second one: a line through both of two edges is of one of them.
  const int first = max_small(0, first_ray(edge.line(edge.from)));
  return {first + (first & (every - 1)), min_small(rays, first_ray(edge.line(edge.to)))};
}

// Adds the places where an edge crosses the middles of the lines, one at least; returns the number of lines.
// `found`: whether a place was added.
int add_edge(const SurfaceMesh& mesh, const SilhouetteEdge& edge, const Lines& lines, int every,
             const SilhouetteRows& equation_rows, const Across& across, SilhouetteFit& fit,
             WorkBudget& budget, bool& found) {
  const std::int32_t length = edge.line(edge.to) - edge.line(edge.from);
  const std::int32_t aside = edge.across(edge.to) - edge.across(edge.from);
  const std::int32_t per_line_q28 = (1 << 28) / length;  // of 1/64 of a ray
  const std::int32_t slope_q14 = (aside * per_line_q28) >> 14;
  const std::int32_t cosine = cosine_q14(min_small(abs(slope_q14), 1 << 14));
  const std::int32_t out_across = edge.outward * cosine;
  const std::int32_t out_along = -((out_across * slope_q14) >> 14);
  // Length of the silhouette per line: 1 / cosine = cosine (1 + slope^2).
  const std::int32_t length_q8 =
      (every * ((cosine * ((1 << 14) + ((slope_q14 * slope_q14) >> 14))) >> 14)) >> 6;

  Rays sum;
  std::int32_t parts_q15 = 0, places = 0;
  int looked_at = 0, equations = 0;
  const auto add_row = [&] {
    constexpr std::array<std::int32_t, kMostPerRow + 1> kInverse_q14{0, 16384, 8192, 5461, 4096};
    const std::int32_t part_q14 = ((parts_q15 >> 1) * kInverse_q14[static_cast<std::size_t>(places)]) >> 14;
    const auto between = [part_q14](std::int32_t a, std::int32_t b) {
      return a + (((b - a) * part_q14 + (1 << 13)) >> 14);
    };
    const SurfaceMesh::Vertex from = mesh.vertex(edge.from_vertex), to = mesh.vertex(edge.to_vertex);
    SurfaceMesh::Vertex vertex{};
    for (std::size_t k = 0; k < 3; ++k) vertex[k] = between(from[k], to[k]);
    const Place place{between(edge.from.column, edge.to.column), between(edge.from.row, edge.to.row),
                      edge.is_steep ? out_across : out_along, edge.is_steep ? out_along : out_across,
                      between(edge.from.inverse_depth, edge.to.inverse_depth)};
    // Every ray of the lines counts once, so that the slope of the silhouette does not matter.
    fit.equations.add(equation_rows.row_of(place, vertex), every * sum.information, every * sum.derivative);
    fit.length_q8 += places * length_q8;
    sum = {};
    parts_q15 = places = 0;
    ++equations;
    found = true;
  };
  for (int line = lines.first; line < lines.end; line += every) {
    const std::int32_t past = line * kScreenRay + kScreenRay / 2 - edge.line(edge.from);
    const std::int32_t part_q15 = (past * (per_line_q28 >> 6)) >> 7;
    const std::int32_t place = edge.across(edge.from) + ((past * slope_q14 + (1 << 13)) >> 14);
    const std::int32_t inverse_depth =
        edge.from.inverse_depth +
        ((((edge.to.inverse_depth - edge.from.inverse_depth) >> 1) * part_q15) >> 14);
    Rays rays_across;
    if (!across.look_across(edge, line, place, inverse_depth, cosine, rays_across, looked_at)) continue;
    sum.derivative += rays_across.derivative;
    sum.information += rays_across.information;
    parts_q15 += part_q15;
    if (++places == kMostPerRow) add_row();
  }
  if (places > 0) add_row();
  const int count = (lines.end - lines.first + every - 1) / every;
  budget.spend(count * work::kPlace + looked_at * work::kAcross + equations * work::kEquation);
  return count;
}

const ScreenPoint& at(const ScreenVertices& vertices, std::int32_t vertex) {
  return vertices[static_cast<std::size_t>(vertex)];
}

// Whether all corners of an edge's triangles are on the screen.
bool is_inside(const SurfaceMesh& mesh, const RenderedSurface& surface, const SurfaceMesh::Edge& edge) {
  // The image was sound when it was loaded, but its memory may have been damaged since.
  if (!mesh.has(edge.first, edge.second, edge.opposite[0], edge.opposite[1])) return false;
  if (surface.is_complete) return true;
  const ScreenVertices& vertices = *surface.vertices;
  return !at(vertices, edge.first).is_outside() && !at(vertices, edge.second).is_outside() &&
         !at(vertices, edge.opposite[0]).is_outside() && !at(vertices, edge.opposite[1]).is_outside();
}

// The triangles on both sides of an edge.
struct Sides {
  bool are_drawn = false;        // with an area on the screen
  bool are_on_one_side = false;  // of the edge, which parts the target from what is behind it
  bool first_is_right = false;   // on the right of the way from the edge's first end to its second
};
Sides sides_of(const ScreenVertices& vertices, const SurfaceMesh::Edge& edge) {
  const ScreenPoint &first = at(vertices, edge.first), &second = at(vertices, edge.second);
  const ScreenPoint &left = at(vertices, edge.opposite[0]), &right = at(vertices, edge.opposite[1]);
  const std::int32_t left_side = area(first, second, left), right_side = area(first, second, right);
  return {left_side != 0 && right_side != 0, (left_side ^ right_side) >= 0, left_side > 0};
}

// `is_right`: the target is on the right of the way from the edge's first end to its second.
SilhouetteEdge silhouette_edge(const ScreenVertices& vertices, const SurfaceMesh::Edge& edge, bool is_right) {
  const ScreenPoint &first = at(vertices, edge.first), &second = at(vertices, edge.second);
  const std::int32_t right_by = second.column - first.column, down_by = second.row - first.row;
  const bool is_steep = abs(down_by) >= abs(right_by);
  const bool is_forward = (is_steep ? down_by : right_by) >= 0;
  // Triangles on the right of the way down are on its left on the screen, and the other way round for the
  // way to the right, where they are below.
  const bool is_outward_positive = is_right == is_forward ? is_steep : !is_steep;
  return {is_steep,
          is_forward ? first : second,
          is_forward ? second : first,
          is_forward ? edge.first : edge.second,
          is_forward ? edge.second : edge.first,
          is_outward_positive ? 1 : -1};
}

}  // namespace

void make_silhouette_table(std::uint32_t fill_q16, SilhouetteTable& table) {
  const Fixed fill =
      Fixed::from_raw(std::int64_t{clamp<std::uint32_t>(fill_q16, kLeastFill_q16, kWholeFill_q16)} << 8);
  for (int i = 0; i < SilhouetteTable::kSteps; ++i) {
    const int step = i - SilhouetteTable::kSteps / 2;
    const Fixed outside =
        sigmoid(Fixed::from_raw(std::int64_t{step} * ((1 << 24) / SilhouetteTable::kPerSigma)));
    const Fixed inside = Fixed(1.0) - outside;
    const Fixed missed = Fixed(1.0) - fill * inside;
    const Fixed derivative = fill * inside * outside / missed;
    const auto q12 = [](Fixed value) { return static_cast<std::int16_t>((value.raw() + 2048) >> 12); };
    const auto at = static_cast<std::size_t>(i);
    table.if_hit[at] = q12(outside);
    table.if_missed[at] = q12(-derivative);
    table.information[at] = q12(outside * derivative);
  }
}

void fit_silhouette(const SurfaceMesh& mesh, const FrameView& view, const Pose& pose,
                    const RenderedSurface& surface, const SilhouetteTable& table, std::int32_t sigma_q8,
                    SilhouetteFit& fit, WorkBudget& budget, int every) {
  fit = {};
  budget.spend(work::kSilhouette + mesh.edges() * work::kEdge);
  const Across across(view, surface, table, sigma_q8);
  const SilhouetteRows rows(view, pose);
  const auto follow = [&](const SilhouetteEdge& edge, const Lines& lines, bool& found) {
    return add_edge(mesh, edge, lines, every, rows, across, fit, budget, found);
  };
  int open = 0, between = 0;  // places
  for (int i = 0; i < mesh.edges() && !budget.is_exhausted(); ++i) {
    const SurfaceMesh::Edge edge = mesh.edge(i);
    if (!is_inside(mesh, surface, edge)) continue;
    const Sides sides = sides_of(*surface.vertices, edge);
    // Between a dark surface and another one is a silhouette, too.
    if (!sides.are_drawn || (!sides.are_on_one_side && !surface.has_dark)) continue;
    SilhouetteEdge silhouette = silhouette_edge(*surface.vertices, edge, sides.first_is_right);
    budget.spend(work::kSilhouetteEdge);
    // Most edges of a fine mesh cross no line.
    const Lines lines = lines_of(silhouette, every, view.rays);
    if (lines.are_none()) continue;
    bool found = false;
    if (!sides.are_on_one_side) {
      silhouette.outward = across.dark_side(silhouette);
      if (silhouette.outward != 0 && between < kMaxPlaces) between += follow(silhouette, lines, found);
      continue;
    }
    if (open >= kMaxPlaces) continue;
    open += follow(silhouette, lines, found);
    if (found || !surface.has_dark) continue;
    // A dark surface before a bright one.
    silhouette.outward = -silhouette.outward;
    open += follow(silhouette, lines, found);
  }
}

}  // namespace tumblesight::gnc
