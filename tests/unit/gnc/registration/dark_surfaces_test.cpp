// Which surfaces a frame shows to be dark. Frames of a box whose sides send rays back or not, as told.
#include "gnc/registration/dark_surfaces.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "gnc/registration/pose_evidence.hpp"
#include "gnc/registration/refinement.hpp"
#include "tests/unit/gnc/registration/scene.hpp"

namespace tumblesight::gnc {
namespace {

constexpr Sensor kSensor{128, 20.0};
constexpr double kDepth_m = 15.0;

// Two plates beside each other, the right one 5 cm nearer, so that no ray meets both.
Body two_plates() {
  Body body;
  body.radius_m = 3.0;
  body.add_plate(-2.0, 0.0, -1.5, 1.5, 0.0);
  body.add_plate(0.0, 2.0, -1.5, 1.5, -0.05);
  return rounded(body);
}

class Dark : public testing::Test {
 protected:
  // Draws `body_` at `truth_` and takes out what is dark in a frame in which a ray that meets the body
  // returns if `returns(row, column)` says so.
  void see(const std::function<bool(int, int)>& returns) {
    const auto depths_m = cast(body_, truth_, kSensor);
    Frame frame(kSensor);
    for (int row = 0; row < kSensor.rays; ++row) {
      for (int column = 0; column < kSensor.rays; ++column) {
        const double depth_m = depths_m[static_cast<std::size_t>(row * kSensor.rays + column)];
        if (depth_m != kNothing && returns(row, column))
          frame.add(row, column, depth_m * ray(kSensor, row, column).norm());
      }
    }
    view_ = view_of(frame, kDepth_m, body_.radius_m, {30, 0});
    const MeshSection section(body_);
    render(section.mesh(), *view_, fixed(truth_), surface_, surface_.budget);
    drawn_ = surface_.filled;
    take_out(section.mesh());
  }
  void take_out(const SurfaceMesh& mesh) {
    measure_brightness(mesh, *view_, surface_, dark_, surface_.budget);
    take_out_dark_surfaces(mesh, *view_, dark_, surface_, surface_.budget);
  }
  int dark_rays() const {
    return count([this](int row, int column) { return surface_.dark.has(row, column); });
  }
  static bool is_left(int column) { return column < kSensor.rays / 2; }
  int count(const std::function<bool(int, int)>& counts) const {
    int sum = 0;
    for (int row = 0; row < kSensor.rays; ++row)
      for (int column = 0; column < kSensor.rays; ++column) sum += counts(row, column) ? 1 : 0;
    return sum;
  }
  int taken_out(bool left) const {
    return count([&](int row, int column) {
      return is_left(column) == left && drawn_.has(row, column) && !surface_.is_filled(row, column);
    });
  }
  int drawn(bool left) const {
    return count([&](int row, int column) { return is_left(column) == left && drawn_.has(row, column); });
  }

  Random random_{5};
  Body body_ = two_plates();
  ExactPose truth_{Eigen::Matrix3d::Identity(), {0.0, kDepth_m, 0.0}};
  std::unique_ptr<FrameView> view_;
  Rendering surface_;
  RayMask drawn_;
  DarkSurfaces dark_;
};

TEST_F(Dark, NothingIsWhereAllRaysReturn) {
  see([](int, int) { return true; });
  EXPECT_EQ(dark_.surfaces, 0);
  EXPECT_FALSE(surface_.has_dark);
  EXPECT_EQ(taken_out(true) + taken_out(false), 0);
}

TEST_F(Dark, IsAPlateThatSendsNothingBack) {
  see([](int, int column) { return !is_left(column); });
  EXPECT_TRUE(surface_.has_dark);
  EXPECT_EQ(dark_.surfaces, 2) << "its triangles";
  EXPECT_EQ(taken_out(true), drawn(true));
  EXPECT_EQ(taken_out(false), 0);
  EXPECT_EQ(dark_rays(), drawn(true));
}

// It still hides what is behind it.
TEST_F(Dark, SurfacesKeepTheirInverseDepth) {
  see([](int, int column) { return !is_left(column); });
  EXPECT_EQ(count([&](int row, int column) {
              return drawn_.has(row, column) && surface_.at(row, column) == RenderedSurface::kEmpty;
            }),
            0);
}

// Less than a fifth of its rays, and less than half of the share of the bright ones.
TEST_F(Dark, IsAPlateOfWhichLessThanAFifthReturns) {
  for (const double share : {0.1, 0.17, 0.23, 0.3}) {
    see([&](int, int column) { return !is_left(column) || random_.happens(share); });
    EXPECT_EQ(taken_out(true) > 0, share < 0.2) << share;
    EXPECT_EQ(taken_out(false), 0) << share;
  }
  constexpr double kBright = 0.3;
  for (const double share : {0.05, 0.12, 0.18}) {
    see([&](int, int column) { return random_.happens(is_left(column) ? share : kBright); });
    EXPECT_EQ(taken_out(true) > 0, share < 0.5 * kBright) << share;
    EXPECT_EQ(taken_out(false), 0) << share;
  }
}

// A frame that loses most of its returns everywhere has no dark surface.
TEST_F(Dark, NothingIsWhereAllSurfacesLoseTheSameShare) {
  for (const double share : {0.05, 0.15, 0.5}) {
    see([&](int, int) { return random_.happens(share); });
    EXPECT_EQ(taken_out(true) + taken_out(false), 0) << share;
  }
}

TEST_F(Dark, RaysThatSomethingHidesDoNotCount) {
  const auto depths_m = cast(body_, truth_, kSensor);
  Frame frame(kSensor);
  for (int row = 0; row < kSensor.rays; ++row) {
    for (int column = 0; column < kSensor.rays; ++column) {
      const double depth_m = depths_m[static_cast<std::size_t>(row * kSensor.rays + column)];
      if (depth_m == kNothing) continue;
      if (is_left(column)) {
        frame.hide(row, column, 0.5 * kDepth_m);
      } else {
        frame.add(row, column, depth_m * ray(kSensor, row, column).norm());
      }
    }
  }
  view_ = view_of(frame, kDepth_m, body_.radius_m, {30, 0});
  const MeshSection section(body_);
  render(section.mesh(), *view_, fixed(truth_), surface_, surface_.budget);
  take_out(section.mesh());
  EXPECT_EQ(dark_.surfaces, 0);
}

// A ball of triangles too small to be judged alone, which returns within 40 degrees of its normal only: what
// is taken out is the rim.
TEST_F(Dark, SmallTrianglesAreJudgedByTheirAngleOfIncidence) {
  body_ = rounded(ball());
  const double radius_rays = kSensor.rays / (2.0 * kDepth_m * kSensor.tan_half_fov());
  const auto from_middle = [&](int row, int column) {
    return std::hypot(row + 0.5 - 0.5 * kSensor.rays, column + 0.5 - 0.5 * kSensor.rays) / radius_rays;
  };
  see([&](int row, int column) { return from_middle(row, column) < std::sin(40.0 * M_PI / 180.0); });
  ASSERT_TRUE(surface_.has_dark);
  const auto is_wrong = [&](int row, int column) {
    const double angle_deg = std::asin(std::min(1.0, from_middle(row, column))) * 180.0 / M_PI;
    if (!drawn_.has(row, column) || std::abs(angle_deg - 40.0) < 15.0) return false;  // a facet's width
    return surface_.is_filled(row, column) != (angle_deg < 40.0);
  };
  EXPECT_EQ(count(is_wrong), 0);
}

// Of a dark plate all triangles are found whose rays would bring six returns, were it bright.
TEST_F(Dark, TrianglesOfEverySizeAreJudged) {
  for (const int strips : {20, 60, 100, 140, 220}) {
    body_ = Body();
    body_.radius_m = 3.0;
    for (int i = 0; i < strips; ++i) {
      const double low = -1.5 + 3.0 * i / strips, high = -1.5 + 3.0 * (i + 1) / strips;
      body_.add_plate(-2.0, 0.0, low, high, 0.0);
      body_.add_plate(0.0, 2.0, low, high, -0.05);
    }
    body_ = rounded(body_);
    for (const double share : {0.4, 0.7, 1.0}) {
      see([&](int, int column) { return !is_left(column) && random_.happens(share); });
      if (drawn(true) * share < 6.5 * 2 * strips) continue;
      EXPECT_GT(taken_out(true), 0) << strips << ' ' << share;
    }
  }
}

// A plate farther away, of which returns come from beside the nearer one only: its hidden rays are not its
// own.
TEST_F(Dark, RaysOfASurfaceThatANearerOneHidesAreNotCounted) {
  body_ = Body();
  body_.radius_m = 3.0;
  body_.add_plate(-2.0, 2.0, -1.5, 1.5, 1.0);   // bright
  body_.add_plate(-1.0, 1.0, -0.8, 0.8, -1.0);  // nearer, and dark
  body_ = rounded(body_);
  const auto depths_m = cast(body_, truth_, kSensor);
  see([&](int row, int column) {
    return depths_m[static_cast<std::size_t>(row * kSensor.rays + column)] > kDepth_m;
  });
  EXPECT_EQ(dark_.surfaces, 2);
  EXPECT_EQ(count([&](int row, int column) {
              const double depth_m = depths_m[static_cast<std::size_t>(row * kSensor.rays + column)];
              return depth_m != kNothing && surface_.dark.has(row, column) != (depth_m < kDepth_m);
            }),
            0);
}

// The angle of incidence is between normal and ray: a ball far off the boresight has its rim where one on it
// has.
TEST_F(Dark, TheAngleOfIncidenceIsThatOfTheRay) {
  body_ = rounded(ball());
  const double aside = 0.12;  // tangent of the angle from the boresight
  truth_.origin_m = {aside * kDepth_m, kDepth_m, 0.0};
  const auto depths_m = cast(body_, truth_, kSensor);
  const auto cosine = [&](int row, int column) {  // of the angle of incidence on the ball
    const double depth_m = depths_m[static_cast<std::size_t>(row * kSensor.rays + column)];
    if (depth_m == kNothing) return 0.0;
    const Eigen::Vector3d direction = ray(kSensor, row, column);
    return (truth_.origin_m - depth_m * direction).normalized().dot(direction.normalized());
  };
  see([&](int row, int column) { return cosine(row, column) > std::cos(40.0 * M_PI / 180.0); });
  ASSERT_TRUE(surface_.has_dark);
  const auto is_wrong = [&](int row, int column) {
    const double angle_deg = std::acos(cosine(row, column)) * 180.0 / M_PI;
    if (!drawn_.has(row, column) || std::abs(angle_deg - 40.0) < 15.0) return false;
    return surface_.is_filled(row, column) != (angle_deg < 40.0);
  };
  EXPECT_EQ(count(is_wrong), 0);
}

// The length of the silhouette that places were found on, in rays.
double silhouette_length(const SurfaceMesh& mesh, const FrameView& view, const ExactPose& truth,
                         const RenderedSurface& surface) {
  SilhouetteTable table;
  SilhouetteFit fit;
  WorkBudget budget;
  make_silhouette_table(65'000, table);
  fit_silhouette(mesh, view, fixed(truth), surface, table, 128, fit, budget);
  return static_cast<double>(fit.length_q8) / 256.0;
}
double rays_per_m(double depth_m) {
  return kSensor.rays / (2.0 * depth_m * kSensor.tan_half_fov());
}

// Two plates in one plane that share an edge: 2 x 3 m are bright.
TEST_F(Dark, TheEdgeBetweenADarkAndABrightSurfaceIsASilhouette) {
  body_ = Body();
  body_.radius_m = 3.0;
  for (const double z : {-1.5, 1.5})
    for (const double x : {-2.0, 0.0, 2.0}) body_.corners.emplace_back(x, 0.0, z);
  body_.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
  body_ = rounded(body_);
  truth_.origin_m.x() = 0.04;  // the edges are not on the middles of rays
  see([](int, int column) { return !is_left(column); });
  ASSERT_EQ(dark_.surfaces, 2);
  const MeshSection section(body_);
  EXPECT_NEAR(silhouette_length(section.mesh(), *view_, truth_, surface_), 10.0 * rays_per_m(kDepth_m), 8.0);
}

// Inside the silhouette of a bright plate lies that of a dark one before it.
TEST_F(Dark, TheSilhouetteOfADarkSurfaceBeforeABrightOneIsSeenFromOutside) {
  body_ = Body();
  body_.radius_m = 3.0;
  body_.add_plate(-2.0, 2.0, -1.5, 1.5, 1.0);
  body_.add_plate(-1.0, 1.0, -0.8, 0.8, -1.0);
  body_ = rounded(body_);
  truth_.origin_m += Eigen::Vector3d(0.04, 0.0, 0.03);
  const auto depths_m = cast(body_, truth_, kSensor);
  see([&](int row, int column) {
    return depths_m[static_cast<std::size_t>(row * kSensor.rays + column)] > kDepth_m;
  });
  ASSERT_EQ(dark_.surfaces, 2);
  const MeshSection section(body_);
  EXPECT_NEAR(silhouette_length(section.mesh(), *view_, truth_, surface_),
              14.0 * rays_per_m(kDepth_m + 1.0) + 7.2 * rays_per_m(kDepth_m - 1.0), 12.0);
}

// Its work would have no limit.
TEST_F(Dark, NothingIsOfASurfaceThatIsNotDrawnWhole) {
  see([](int, int column) { return !is_left(column); });
  surface_.is_complete = false;
  const MeshSection section(body_);
  surface_.has_dark = false;
  take_out_dark_surfaces(section.mesh(), *view_, dark_, surface_, surface_.budget);
  EXPECT_EQ(dark_.surfaces, 0);
  EXPECT_FALSE(surface_.has_dark);
}

// The pose of the two plates is found by the one that returns, and the edge between them is a silhouette.
TEST_F(Dark, APoseIsFoundThoughAPlateSendsNothingBack) {
  see([](int, int column) { return !is_left(column); });
  RefinementScratch scratch;
  scratch.surface.vertices = &surface_.memory;
  const MeshSection section(body_);
  const Pose start = fixed(moved(truth_, {0.01, 0.02, -0.01}, {0.06, 0.05, 0.04}));
  Refinement result;
  refine(section.mesh(), *view_, start, {6, 3, 512, 40, 4194304, 8388608}, scratch, result);
  const ExactPose found = exact(result.pose);
  EXPECT_LT((found.origin_m - truth_.origin_m).norm(), 0.03) << found.origin_m.transpose();
  EXPECT_LT((found.r_lrf_trf - truth_.r_lrf_trf).norm(), 0.01);
  const PoseEvidence evidence = evidence_of(*view_, scratch.surface, scratch.ranges, scratch.dark.surfaces);
  EXPECT_GT(evidence.dark, drawn(true) * 9 / 10);
  EXPECT_EQ(evidence.missing, 0);
  EXPECT_GT(evidence.missing_ppm(), 400'000U) << "dark rays count for the verdict";
}

}  // namespace
}  // namespace tumblesight::gnc
