// Verifies TS-NUM-010.
#include "gnc/lidar/depth_loops.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace tumblesight::gnc {
namespace {

using Range = std::function<int(int ray)>;

struct FrameKind {
  const char* name;
  Range range;
};

// Gives the same numbers on every platform for the same seed.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  int below(int limit) { return static_cast<int>(engine_() % static_cast<unsigned>(limit)); }

 private:
  std::mt19937 engine_;
};

std::vector<FrameKind> frame_kinds(Random& random) {
  return {{"Noise", [&](int) { return random.below(65536); }},
          {"Target", [&](int ray) { return ray % 5 == 0 ? 0 : 6400 + random.below(400); }},
          {"NearestAndFarthest", [](int ray) { return ray % 2 == 0 ? 1280 : 64000; }},
          {"OneFarReturn", [](int ray) { return ray == 77 ? 64000 : 1280 + ray % 3; }},
          {"Sparse", [&](int) { return random.below(100) == 0 ? 2000 + random.below(100) : 0; }}};
}

std::unique_ptr<RangeImage> frame_of(const Range& range, std::uint16_t rays, std::uint32_t fov_urad) {
  auto frame = std::make_unique<RangeImage>();
  frame->rays = rays;
  frame->fov_urad = fov_urad;
  for (int i = 0; i < rays * rays; ++i)
    frame->ranges[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(range(i));
  return frame;
}

class DepthLoopsOf : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void expect_equal(const RangeImage& frame, const DepthProjection& projection) {
    const FrameStatus expected =
        make_depth_image(frame, projection, *scratch, *image, fastest_depth_loops(InstructionSet::kPortable));
    const FrameStatus found =
        make_depth_image(frame, projection, *scratch, *other, fastest_depth_loops(GetParam()));
    ASSERT_EQ(found, expected);
    if (expected != FrameStatus::kOk) return;
    EXPECT_EQ(other->depth, image->depth);
    EXPECT_TRUE(other->r_lrf_view == image->r_lrf_view);
  }

  std::unique_ptr<DepthImageScratch> scratch = std::make_unique<DepthImageScratch>();
  std::unique_ptr<DepthImage> image = std::make_unique<DepthImage>();
  std::unique_ptr<DepthImage> other = std::make_unique<DepthImage>();
};

TEST_P(DepthLoopsOf, HaveTheBitsOfThePortableLoops) {
  if (fastest_depth_loops(GetParam()).set != GetParam())
    GTEST_SKIP() << "no loops for this set, or not on this processor";
  Random random(20);
  for (const FrameKind& kind : frame_kinds(random)) {
    for (const int rays : {16, 17, 31, 100, 127, 128}) {
      for (const std::uint32_t fov_urad : {kMinFov_urad, 140'000U, kMaxFov_urad}) {
        const auto frame = frame_of(kind.range, static_cast<std::uint16_t>(rays), fov_urad);
        for (const std::uint32_t swath_mm : {kMinProjection_mm, 7'000U, kMaxSwath_mm}) {
          for (const std::uint32_t radius_mm : {kMinProjection_mm, 3'800U, kMaxTargetRadius_mm}) {
            SCOPED_TRACE(std::string(kind.name) + ' ' + std::to_string(rays) + ' ' +
                         std::to_string(fov_urad) + ' ' + std::to_string(swath_mm) + ' ' +
                         std::to_string(radius_mm));
            expect_equal(*frame, {swath_mm, radius_mm});
          }
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EverySet, DepthLoopsOf, ::testing::ValuesIn(kInstructionSets), [](const auto& set) {
  std::string name = to_string(set.param);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace tumblesight::gnc
