// What speaks against a pose, counted ray by ray on small hand-made screens.
#include "gnc/registration/pose_evidence.hpp"

#include <gtest/gtest.h>

#include "tests/unit/gnc/registration/scene.hpp"

namespace tumblesight::gnc {
namespace {

constexpr Sensor kSensor{64, 20.0};
constexpr std::int32_t kNat_q8 = 256;

// A square is drawn. What returns, and what is hidden or dark, is up to the test.
class Evidence : public testing::Test {
 protected:
  static constexpr int kFirst = 20, kLast = 39, kSide = kLast - kFirst + 1;
  // At the silhouette: the outermost rays of the square and those next to them.
  static constexpr int kInside = (kSide - 2) * (kSide - 2);
  static constexpr int kSilhouette = (kSide + 2) * (kSide + 2) - kInside;

  Evidence() {
    surface_.rays = kSensor.rays;
    surface_.has_dark = false;
    surface_.filled = {};
    surface_.dark = {};
    view_->returned = view_->hidden = {};
    for_square(kFirst, kLast, [this](int row, int column) {
      set(surface_.filled, row, column);
      set(view_->returned, row, column);
    });
  }
  template <class Do>
  static void for_square(int first, int last, Do&& action) {
    for (int row = first; row <= last; ++row)
      for (int column = first; column <= last; ++column) action(row, column);
  }
  static std::uint32_t bit(int column) { return 0x8000'0000U >> (column % RayMask::kColumnsPerWord); }
  static std::uint32_t& word(RayMask& mask, int row, int column) {
    return mask
        .rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column / RayMask::kColumnsPerWord)];
  }
  static void set(RayMask& mask, int row, int column) { word(mask, row, column) |= bit(column); }
  static void clear(RayMask& mask, int row, int column) { word(mask, row, column) &= ~bit(column); }
  void make_dark(int row, int column) {
    clear(surface_.filled, row, column);
    set(surface_.dark, row, column);
    surface_.has_dark = true;
  }
  PoseEvidence evidence(int dark_surfaces = 0) const {
    return evidence_of(*view_, surface_, RangeFit(), dark_surfaces);
  }

  std::unique_ptr<FrameView> view_ = empty_view(kSensor, 15.0, 3.0);
  Rendering surface_;
};

TEST_F(Evidence, OfARightPoseSpeaksAgainstNothing) {
  const PoseEvidence found = evidence();
  EXPECT_EQ(found.drawn, kInside);
  EXPECT_EQ(found.returned, kSide * kSide);
  EXPECT_EQ(found.silhouette_rays, kSilhouette);
  EXPECT_EQ(found.missing + found.unexplained + found.silhouette + found.dark + found.dark_returned, 0);
  EXPECT_EQ(found.cost_q8(), 0);
}

// A missing return 2.3 nats, one beside the target 5, one at the silhouette 1.
TEST_F(Evidence, CostsByItsPlace) {
  clear(view_->returned, 30, 30);
  EXPECT_EQ(evidence().missing, 1);
  EXPECT_NEAR(evidence().cost_q8(), 2.3 * kNat_q8, 0.01 * kNat_q8);
  set(view_->returned, 30, 30);
  set(view_->returned, 5, 5);
  EXPECT_EQ(evidence().unexplained, 1);
  EXPECT_EQ(evidence().cost_q8(), 5 * kNat_q8);
  clear(view_->returned, 5, 5);
  clear(view_->returned, kFirst, 30);
  EXPECT_EQ(evidence().silhouette, 1);
  EXPECT_EQ(evidence().cost_q8(), kNat_q8);
}

TEST_F(Evidence, IsNotOfHiddenRays) {
  for_square(25, 29, [this](int row, int column) {
    set(view_->hidden, row, column);
    clear(view_->returned, row, column);
  });
  set(view_->hidden, kFirst, 30);
  clear(view_->returned, kFirst, 30);
  const PoseEvidence found = evidence();
  EXPECT_EQ(found.drawn, kInside - 25);
  EXPECT_EQ(found.silhouette_rays, kSilhouette - 1);
  EXPECT_EQ(found.cost_q8(), 0);
}

// Dark rays are neither drawn nor missing. A surface costs 5 nats.
TEST_F(Evidence, OfDarkRaysCostsTheirSurfaces) {
  for_square(25, 34, [this](int row, int column) {
    make_dark(row, column);
    clear(view_->returned, row, column);
  });
  set(view_->hidden, 30, 30);
  const PoseEvidence found = evidence(2);
  EXPECT_EQ(found.dark, 99);
  EXPECT_EQ(found.missing, 0);
  EXPECT_EQ(found.cost_q8(), 10 * kNat_q8);
  EXPECT_EQ(found.missing_ppm(), 1'000'000U * 99 / (found.drawn + 99)) << "the verdict counts them";
}

// Two nats each. It makes no other return cheaper.
TEST_F(Evidence, OfAReturnFromADarkRayAddsToTheCost) {
  for_square(25, 34, [this](int row, int column) {
    make_dark(row, column);
    clear(view_->returned, row, column);
  });
  set(view_->returned, 5, 5);
  const std::int32_t before_q8 = evidence(1).cost_q8();
  set(view_->returned, 29, 29);
  const PoseEvidence found = evidence(1);
  EXPECT_EQ(found.dark_returned, 1);
  EXPECT_EQ(found.unexplained, 1);
  EXPECT_EQ(found.cost_q8(), before_q8 + 2 * kNat_q8);
  // Beside bright rays it is one at the silhouette.
  set(view_->returned, 25, 29);
  EXPECT_EQ(evidence(1).dark_returned, 1);
  EXPECT_EQ(evidence(1).cost_q8(), before_q8 + 3 * kNat_q8);
}

}  // namespace
}  // namespace tumblesight::gnc
