#include "gnc/registration/triangle_spans.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "tests/support/trials.hpp"
#include "tests/unit/gnc/registration/scene.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kRays = RangeImage::kMaxRays;
// Of a vertex that is drawn, from the middle of the screen [1/64 ray].
constexpr int kFarthest = RangeImage::kMaxRays * kScreenRay;
constexpr int kMiddle = kRays * kScreenRay / 2;

// The corner of a triangle that may be far outside of the screen, or at its limits.
ScreenPoint random_point(Random& random, bool is_at_limit) {
  const auto coordinate = [&] {
    return kMiddle + (is_at_limit ? (random.happens(0.5) ? kFarthest : -kFarthest)
                                  : random.below(2 * kFarthest + 1) - kFarthest);
  };
  const auto inverse_depth =
      is_at_limit ? (random.happens(0.5) ? 32'767 : -32'767) : random.below(65'535) - 32'767;
  return {static_cast<std::int16_t>(coordinate()), static_cast<std::int16_t>(coordinate()),
          static_cast<std::int16_t>(inverse_depth)};
}

TEST(PlaneOf, IsExactAtItsFirstRay) {
  Random random(21);
  int planes = 0;
  for (int i = 0; i < trials(20'000); ++i) {
    const bool is_at_limit = i % 4 == 0;
    ScreenPoint a = random_point(random, is_at_limit), b = random_point(random, is_at_limit);
    const ScreenPoint c = random_point(random, false);
    if (area(a, b, c) < 0) std::swap(a, b);
    const std::int32_t whole = area(a, b, c);
    const Bounds rows = bounds(a.row, b.row, c.row, kRays);
    const Bounds columns = bounds(a.column, b.column, c.column, kRays);
    if (whole == 0 || rows.is_empty() || columns.is_empty()) continue;
    ++planes;
    const Plane plane = plane_of(a, b, c, whole, rows, columns);
    const std::int64_t right = columns.first * kScreenRay + kScreenRay / 2 - a.column;
    const std::int64_t down = rows.first * kScreenRay + kScreenRay / 2 - a.row;
    const std::int64_t from_a = (plane.per_column * right + plane.per_row * down) >> kScreenBits;
    constexpr std::int64_t kMost = 1 << 29;
    ASSERT_EQ(plane.at_first, a.inverse_depth * 256 + 128 + std::clamp(from_a, -kMost, kMost)) << i;
  }
  EXPECT_GT(planes, trials(20'000) / 4);
}

// A triangle drawn alone fills a ray, or it is not among the covering ones.
TEST(TriangleSet, HasTheTrianglesThatCoverARayAlsoWhereOthersHideThem) {
  Random random(22);
  const Sensor sensor;
  int between_rays = 0, hidden = 0;
  for (int i = 0; i < trials(20); ++i) {
    // The ball's triangles are smaller than a ray from afar.
    const Body body = i % 2 == 0 ? lopsided_body() : ball();
    const double depth_m = random.uniform(10.0, 120.0);
    const Pose pose = fixed({random.rotation(), {0.0, depth_m, 0.0}});
    const auto view = empty_view(sensor, depth_m, body.radius_m);
    const MeshSection section(body, MeshSection::Sides::kFront);
    auto whole = std::make_unique<Rendering>();
    render(section.mesh(), *view, pose, *whole, whole->budget);
    for (std::size_t t = 0; t < body.triangles.size(); ++t) {
      Body alone = body;
      alone.triangles = {body.triangles[t]};
      const MeshSection alone_section(alone, MeshSection::Sides::kFront);
      auto drawn = std::make_unique<Rendering>();
      render(alone_section.mesh(), *view, pose, *drawn, drawn->budget);
      const bool covers =
          std::any_of(drawn->inverse_depth.begin(), drawn->inverse_depth.end(),
                      [](std::int16_t inverse_depth) { return inverse_depth != RenderedSurface::kEmpty; });
      const bool is_covering =
          (whole->covering.words[t / TriangleSet::kPerWord] >> (t % TriangleSet::kPerWord) & 1U) != 0;
      ASSERT_EQ(is_covering, covers) << i << ", triangle " << t;
      // Nothing of it is what the whole surface shows.
      bool is_hidden = covers;
      for (std::size_t ray = 0; ray < drawn->inverse_depth.size() && is_hidden; ++ray)
        is_hidden = drawn->inverse_depth[ray] == RenderedSurface::kEmpty ||
                    drawn->inverse_depth[ray] < whole->inverse_depth[ray];
      between_rays += covers ? 0 : 1;
      hidden += is_hidden ? 1 : 0;
    }
  }
  EXPECT_GT(between_rays, 0);
  EXPECT_GT(hidden, 0);
}

}  // namespace
}  // namespace tumblesight::gnc
