// Verifies TS-EST-190.
#include "gnc/registration/inlier_ratios.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include "gnc/numerics/conversion.hpp"

namespace tumblesight::gnc {
namespace {

// Cells of 0.2 m, of which a cell of the depth image is a half. Far enough for a parallel view.
constexpr DepthProjection kProjection{10'000, 4'000};
constexpr std::int32_t kDistance_mm = 400'000;

class Surface {
 public:
  Surface() : bytes_(SurfaceModel::kBytes) {}
  void add(const Eigen::Vector3d& position_m, const Eigen::Vector3d& normal) {
    std::uint8_t* at = bytes_.data() + SurfaceModel::kHeaderBytes + SurfaceModel::kPointBytes * points_++;
    for (int k = 0; k < 3; ++k) {
      const auto scaled = static_cast<std::int16_t>(std::lround(32767.0 * position_m[k] / 4.0));
      at[2 * k] = static_cast<std::uint8_t>(scaled);
      at[2 * k + 1] = static_cast<std::uint8_t>(scaled >> 8);
      at[6 + k] = static_cast<std::uint8_t>(std::lround(127.0 * normal[k]));
    }
    bytes_[0] = static_cast<std::uint8_t>(points_);
    bytes_[1] = static_cast<std::uint8_t>(points_ >> 8);
  }
  // A plate across the view, 5 points a metre, on the side that faces the sensor.
  void add_plate(double width_m, double height_m, double depth_m) {
    for (double x = -0.5 * width_m + 0.1; x < 0.5 * width_m; x += 0.2) {
      for (double z = -0.5 * height_m + 0.1; z < 0.5 * height_m; z += 0.2)
        add({x, depth_m, z}, {0.0, -1.0, 0.0});
    }
  }
  SurfaceModel model() const { return SurfaceModel(bytes_.data()); }
  std::vector<std::uint8_t>& bytes() { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t points_ = 0;
};

// A rectangle of returns, around a point right and down of the middle, at a depth behind the centroid.
void show(DepthImage& image, double width_m, double height_m, double right_m = 0.0, double down_m = 0.0,
          double depth_m = 0.0) {
  image.centroid_distance_mm = kDistance_mm;
  for (int row = 0; row < DepthImage::kSide; ++row) {
    for (int column = 0; column < DepthImage::kSide; ++column) {
      const double x = 0.1 * (column + 0.5) - 5.0 - right_m, down = 0.1 * (row + 0.5) - 5.0 - down_m;
      if (std::abs(x) > 0.5 * width_m || std::abs(down) > 0.5 * height_m) continue;
      image.depth[static_cast<std::size_t>(row * DepthImage::kSide + column)] =
          static_cast<std::uint16_t>(std::lround(65536.0 * (0.5 - 0.5 * depth_m / 4.0)));
    }
  }
}

InlierRatios explain(const DepthImage& image, const SurfaceModel& surface,
                     const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity(),
                     const RangeNoise& noise = {}) {
  static const auto scratch = std::make_unique<InlierRatiosScratch>();
  Matrix3<Fixed> r_lrf_trf;
  for (int i = 0; i < 9; ++i) r_lrf_trf(i) = Fixed(rotation(i));
  return inlier_ratios(image, kProjection, noise, r_lrf_trf, surface, *scratch);
}

double share(std::uint32_t q16) {
  return q16 / 65536.0;
}

TEST(InlierRatios, IsNotKnownWithoutASurface) {
  DepthImage image;
  show(image, 4.0, 2.0);
  EXPECT_FALSE(explain(image, SurfaceModel()).is_known);
  EXPECT_FALSE(explain(image, Surface().model()).is_known);
}

TEST(InlierRatios, IsWholeForThePlateThatIsThere) {
  Surface surface;
  surface.add_plate(4.0, 2.0, 0.5);
  DepthImage image;
  show(image, 4.0, 2.0);
  const InlierRatios found = explain(image, surface.model());
  EXPECT_TRUE(found.is_known);
  EXPECT_EQ(found.outliers, 0U);
  EXPECT_EQ(found.missing, 0U);
  EXPECT_LT(share(found.depth_misfit), 0.05);
}

// The drawing is one or two cells larger than the plate, and a cell beside it still fits.
TEST(InlierRatios, CountsReturnsWhereTheTargetIsNot) {
  Surface surface;
  surface.add_plate(2.0, 2.0, 0.0);
  DepthImage image;
  show(image, 6.0, 2.0);
  const InlierRatios found = explain(image, surface.model());
  EXPECT_NEAR(share(found.outliers), (30.0 - 13.5) / 30.0, 1.0 / 30.0);
  EXPECT_LT(share(found.missing), 0.1) << "the rows above and below";
}

TEST(InlierRatios, CountsTargetWhereNoReturnsAre) {
  Surface surface;
  surface.add_plate(4.0, 2.0, 0.0);
  DepthImage image;
  show(image, 2.0, 2.0);  // the half that is not hidden, in the middle of the image as its centroid is
  const InlierRatios found = explain(image, surface.model());
  EXPECT_EQ(found.outliers, 0U);
  EXPECT_NEAR(share(found.missing), (20.0 - 11.0) / 20.0, 1.5 / 20.0);
}

TEST(InlierRatios, FallsWithAnAttitudeThatIsWrong) {
  Surface surface;
  surface.add_plate(4.0, 1.0, 0.0);
  DepthImage image;
  show(image, 4.0, 1.0);
  const Eigen::Matrix3d quarter = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const InlierRatios right = explain(image, surface.model());
  const InlierRatios wrong = explain(image, surface.model(), quarter);
  EXPECT_LT(misfit_of(right), kWholeShare / 20);
  EXPECT_GT(share(wrong.outliers), 0.5);
  EXPECT_GT(share(wrong.missing), 0.5);
}

TEST(InlierRatios, DoesNotDependOnWhereTheTargetIsUpToFourCells) {
  Surface surface;
  surface.add_plate(3.0, 2.0, 0.0);
  // Three cells wider or higher than the plate, which the drawing with a cell around it covers in one place.
  for (int i = 0; i < 2 * 81; ++i) {
    const int right = i % 9 - 4, down = i / 9 % 9 - 4;
    DepthImage image;
    show(image, i < 81 ? 3.6 : 3.0, i < 81 ? 2.0 : 2.6, 0.2 * right, 0.2 * down);
    const InlierRatios found = explain(image, surface.model());
    EXPECT_EQ(found.outliers, 0U) << right << ' ' << down;
    EXPECT_EQ(found.missing, 0U) << right << ' ' << down;
  }
  DepthImage image;
  show(image, 3.0, 2.0, 2.0);
  EXPECT_GT(explain(image, surface.model()).outliers, kWholeShare / 4);
}

// Half of the target is deeper by far more than 2.5 sigma than the median, which lies on the other half.
TEST(InlierRatios, ComparesDepths) {
  Surface surface;
  surface.add_plate(4.0, 2.0, 0.0);
  DepthImage image;
  image.centroid_distance_mm = 20'000;
  show(image, 2.0, 2.0, -1.0, 0.0, -2.0);
  show(image, 2.0, 2.0, 1.0, 0.0, 2.0);
  image.centroid_distance_mm = 20'000;
  EXPECT_NEAR(share(explain(image, surface.model()).depth_misfit), 0.5, 0.06);
}

// A part of the returns is half a metre deeper than the others, where the target is flat.
TEST(InlierRatios, MeasuresDepthsByTheNoiseOfTheSensor) {
  Surface surface;
  surface.add_plate(4.0, 2.0, 0.0);
  DepthImage image;
  show(image, 2.2, 2.0, -0.9, 0.0, 0.0);
  show(image, 1.8, 2.0, 1.1, 0.0, 0.5);
  image.centroid_distance_mm = 50'000;
  const auto misfit = [&](const RangeNoise& noise) {
    return share(explain(image, surface.model(), Eigen::Matrix3d::Identity(), noise).depth_misfit);
  };
  const auto expected = [](double sigma_m) {
    return 0.45 * std::min(1.0, 0.5 / (2.5 * std::hypot(sigma_m / std::sqrt(6.5), 0.03 * 4.0)));
  };
  EXPECT_NEAR(misfit({100, 1000}), expected(0.1 + 0.5), 0.04);
  EXPECT_NEAR(misfit({300, 1000}), expected(0.3 + 0.5), 0.04);
  EXPECT_NEAR(misfit({100, 4000}), expected(0.1 + 2.0), 0.04);
  EXPECT_NEAR(misfit({0, 0}), expected(0.0), 0.06);
  EXPECT_GT(misfit({0, 0}) - misfit({100, 4000}), 0.2);
}

TEST(InlierRatios, ShowsTheNearestSurfaceOnly) {
  Surface surface;
  surface.add_plate(4.0, 2.0, 1.0);
  surface.add_plate(4.0, 2.0, -1.0);
  DepthImage image;
  show(image, 4.0, 2.0);
  EXPECT_LT(share(explain(image, surface.model()).depth_misfit), 0.05);
}

TEST(InlierRatios, DrawsOnlyWhatFacesTheSensor) {
  Surface surface;
  for (double x = -1.9; x < 2.0; x += 0.2) surface.add({x, 0.0, 0.0}, {0.0, 1.0, 0.0});
  DepthImage image;
  show(image, 4.0, 2.0);
  const InlierRatios found = explain(image, surface.model());
  EXPECT_EQ(found.outliers, kWholeShare);
  EXPECT_EQ(found.depth_misfit, kWholeShare) << "no cell in common";
  EXPECT_EQ(found.missing, 0U) << "of nothing";
}

// A wall beside the line of sight faces a near sensor, though its normal is across the boresight.
TEST(InlierRatios, KnowsTheDirectionFromTheSensor) {
  Surface surface;
  for (double z = -0.9; z < 1.0; z += 0.2) surface.add({3.5, 0.0, z}, {-1.0, 0.0, 0.0});
  DepthImage image;
  show(image, 0.2, 2.0);
  image.centroid_distance_mm = 12'000;
  EXPECT_EQ(explain(image, surface.model()).outliers, 0U);
  image.centroid_distance_mm = 100'000;
  EXPECT_EQ(explain(image, surface.model()).outliers, kWholeShare);
}

TEST(InlierRatios, StaysWithinItsRangeForAnyContent) {
  std::mt19937 engine(5);
  std::uniform_int_distribution<int> byte(0, 255);
  Surface surface;
  for (int run = 0; run < 20; ++run) {
    for (std::uint8_t& b : surface.bytes()) b = static_cast<std::uint8_t>(byte(engine));
    DepthImage image;
    for (std::uint16_t& depth : image.depth) depth = static_cast<std::uint16_t>(byte(engine) * 257);
    image.centroid_distance_mm = run % 3 == 0 ? -5 : run % 3 == 1 ? 0x7FFFFFFF : 10'000;
    Matrix3<Fixed> matrix;
    for (int i = 0; i < 9; ++i)
      matrix(i) = Fixed::from_raw(run % 2 == 0 ? Fixed::kLargestRaw : -Fixed::kLargestRaw);
    const auto scratch = std::make_unique<InlierRatiosScratch>();
    for (const DepthProjection& projection : {DepthProjection{100, 100'000}, DepthProjection{100'000, 100}}) {
      const RangeNoise noise = run % 5 == 0 ? RangeNoise{0, 0} : RangeNoise{0xFFFF, 0xFFFF};
      const InlierRatios found = inlier_ratios(image, projection, noise, matrix, surface.model(), *scratch);
      EXPECT_LE(found.outliers, kWholeShare);
      EXPECT_LE(found.missing, kWholeShare);
      EXPECT_LE(found.depth_misfit, kWholeShare);
    }
  }
}

TEST(InlierRatios, DoesNotReadTheScratchBeforeItIsWritten) {
  Surface surface;
  surface.add_plate(4.0, 2.0, 0.0);
  DepthImage image;
  show(image, 3.0, 2.0);
  const Matrix3<Fixed> identity = Matrix3<Fixed>::Identity();
  std::vector<InlierRatios> found;
  for (const int fill : {0x00, 0x5A, 0xFF}) {
    const auto scratch = std::make_unique<InlierRatiosScratch>();
    std::memset(scratch.get(), fill, sizeof *scratch);
    found.push_back(inlier_ratios(image, kProjection, RangeNoise{}, identity, surface.model(), *scratch));
  }
  for (const InlierRatios& one : found) {
    EXPECT_EQ(one.outliers, found[0].outliers);
    EXPECT_EQ(one.missing, found[0].missing);
    EXPECT_EQ(one.depth_misfit, found[0].depth_misfit);
  }
}

}  // namespace
}  // namespace tumblesight::gnc
