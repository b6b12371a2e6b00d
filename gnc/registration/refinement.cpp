#include "gnc/registration/refinement.hpp"

#include "gnc/attitude/motion.hpp"
#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"
#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {
namespace {

constexpr std::int32_t kLeastSigma_q8 = 16;      // of fit_silhouette
constexpr std::uint32_t kLeastFill_q16 = 57344;  // 7/8: where less returns, surfaces may be dark

// Both fits together, with 12 fraction bits.
NormalEquations together(const FrameView& view, const SilhouetteFit& silhouette, const RangeFit& ranges,
                         std::int32_t sigma_q8) {
  // (rays per radius / sigma)^2 = scale 2^shift / 2^12. Limits so that nothing overflows where a target
  // covers thousands of rays.
  const std::int64_t per_sigma_q8 = divide(std::int64_t{view.rays_per_radius_q8} << 8, sigma_q8);
  const std::int64_t square_q12 = (per_sigma_q8 * per_sigma_q8) >> 4;
  const int shift = max(0, highest_bit(static_cast<std::uint64_t>(square_q12)) - 26);
  constexpr std::int64_t kMostInformation = std::int64_t{1} << 35, kMostGradient = std::int64_t{1} << 42;
  NormalEquations sum;
  for (std::size_t i = 0; i < sum.information.size(); ++i) {
    const std::int64_t silhouettes =
        clamp(silhouette.equations.information[i] >> 8, -kMostInformation, kMostInformation);
    sum.information[i] =
        ((silhouettes * (square_q12 >> shift)) >> (20 - shift)) + (ranges.equations.information[i] >> 4);
  }
  for (std::size_t i = 0; i < sum.gradient.size(); ++i) {
    const std::int64_t silhouettes =
        clamp(silhouette.equations.gradient[i] >> 6, -kMostGradient, kMostGradient);
    sum.gradient[i] = ((silhouettes * (per_sigma_q8 >> 4)) >> 12) + (ranges.equations.gradient[i] >> 8);
  }
  return sum;
}

// What is known of the pose before the frame: it is `start`, within sigma.
void add_prior(const RefinementSettings& settings, const Motion6& since_start, NormalEquations& equations) {
  for (int i = 0; i < kUnknowns; ++i) {
    const std::int64_t sigma_q24 = i < 3 ? settings.turn_sigma_q24 : settings.move_sigma_q24;
    const std::int64_t inverse_q12 = divide(std::int64_t{1} << 36, sigma_q24);
    const std::int64_t weight_q12 = (inverse_q12 * inverse_q12) >> 12;
    const auto at = static_cast<std::size_t>(i);
    equations.information[element(i, i)] += weight_q12;
    equations.gradient[at] -= (weight_q12 * since_start[at]) >> 24;
  }
}

void move(const FrameView& view, const Motion6& step, Pose& pose) {
  const Vector3<Fixed> turn{Fixed::from_raw(step[0]), Fixed::from_raw(step[1]), Fixed::from_raw(step[2])};
  pose.r_lrf_trf = product<Fixed>(rotation_from_vector<Fixed>(turn), pose.r_lrf_trf);
  const RotationColumns<Fixed> columns =
      orthonormalize<Fixed>(Vector3<Fixed>(pose.r_lrf_trf.col(0)), Vector3<Fixed>(pose.r_lrf_trf.col(1)));
  pose.r_lrf_trf = rotation_from_columns<Fixed>(columns);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t um = (std::int64_t{step[i + 3]} * view.target_radius_um + (1 << 23)) >> 24;
    pose.origin_lrf_um[i] += static_cast<std::int32_t>(um);
  }
}

// Turn and move of a step are limited to a tenth of a radian and of a radius, in their directions.
void limit(Motion6& step) {
  constexpr std::int32_t kLargest = (1 << 24) / 10;
  for (std::size_t first = 0; first < step.size(); first += 3) {
    std::uint64_t square = 0;
    for (std::size_t i = first; i < first + 3; ++i)
      square += static_cast<std::uint64_t>(std::int64_t{step[i]} * step[i]);
    const std::int64_t length = max<std::int64_t>(kLargest, integer_sqrt(square));
    for (std::size_t i = first; i < first + 3; ++i)
      step[i] = static_cast<std::int32_t>(divide(std::int64_t{step[i]} * kLargest, length));
  }
}

}  // namespace

void refine(const SurfaceMesh& mesh, const FrameView& view, const Pose& start,
            const RefinementSettings& settings, RefinementScratch& scratch, Refinement& result) {
  result.pose = start;
  render(mesh, view, start, scratch.surface, scratch.budget);
  refine_further(mesh, view, settings, scratch, result);
}

void refine_further(const SurfaceMesh& mesh, const FrameView& view, const RefinementSettings& settings,
                    RefinementScratch& scratch, Refinement& result) {
  RenderedSurface& surface = scratch.surface;
  WorkBudget& budget = scratch.budget;
  result.is_complete = budget.spend(work::kRefinement) && surface.is_complete;
  if (budget.is_exhausted()) return;
  result.fill_q16 = fill_share(view, surface);
  const bool may_be_dark = surface.has_dark || result.fill_q16 < kLeastFill_q16;
  const auto take_out_dark = [&] {
    take_out_dark_surfaces(mesh, view, scratch.dark, surface, budget);
    result.fill_q16 = fill_share(view, surface);
  };
  if (may_be_dark && !surface.has_dark) {
    measure_brightness(mesh, view, surface, scratch.dark, budget);
    take_out_dark();
  }
  Motion6 since_start{};
  const std::int32_t last_sigma_q8 = max(settings.last_sigma_q8, kLeastSigma_q8);
  std::int32_t sigma_q8 = max(settings.first_sigma_q8, last_sigma_q8);
  const int steps = clamp(settings.steps, 1, RefinementSettings::kMaxSteps);
  const auto every = [&](int step) { return step < settings.thinned_steps && step < steps ? 2 : 1; };
  fit_ranges(view, result.pose, surface, scratch.ranges, budget, every(0));
  for (int i = 0; i < steps && budget.spend(work::kStep); ++i) {
    const std::int32_t left_before = budget.left();
    if (i == 0 || may_be_dark) {
      budget.spend(work::kTable);
      make_silhouette_table(result.fill_q16, scratch.table);
    }
    fit_silhouette(mesh, view, result.pose, surface, scratch.table, sigma_q8, scratch.silhouette, budget,
                   every(i));
    result.equations = together(view, scratch.silhouette, scratch.ranges, sigma_q8);
    NormalEquations damped = result.equations;
    add_prior(settings, since_start, damped);
    Motion6 step = solve(damped);
    limit(step);
    move(view, step, result.pose);
    for (std::size_t k = 0; k < step.size(); ++k) since_start[k] += step[k];
    sigma_q8 = max(last_sigma_q8, sigma_q8 / 2);
    render(mesh, view, result.pose, surface, budget);
    result.is_complete = result.is_complete && surface.is_complete;
    if (may_be_dark) take_out_dark();
    fit_ranges(view, result.pose, surface, scratch.ranges, budget, every(i + 1));
    scratch.dearest_step = max(scratch.dearest_step, work::kStep + left_before - budget.left());
  }
  result.is_complete = result.is_complete && !budget.is_exhausted();
}

}  // namespace tumblesight::gnc
