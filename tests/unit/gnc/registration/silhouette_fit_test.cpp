#include "gnc/registration/silhouette_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/trials.hpp"
#include "tests/unit/gnc/registration/scene.hpp"

namespace tumblesight::gnc {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr Sensor kSensor{128, 20.0};
constexpr double kDepth_m = 15.0;
constexpr double kFill = 0.9;
constexpr std::int32_t kSigma_q8 = 256;  // a ray

// Of a ray at `outside` standard deviations outside of the silhouette.
double probability_of_return(double fill, double outside) {
  return fill / (1.0 + std::exp(outside));
}
double log_likelihood(double fill, double outside, bool is_hit) {
  const double returns = probability_of_return(fill, outside);
  return std::log(is_hit ? returns : 1.0 - returns);
}
// By a silhouette that moves outwards.
double derivative(double fill, double outside, bool is_hit) {
  constexpr double kStep = 1e-5;
  return (log_likelihood(fill, outside - kStep, is_hit) - log_likelihood(fill, outside + kStep, is_hit)) /
         (2.0 * kStep);
}
double fisher_information(double fill, double outside) {
  const double returns = probability_of_return(fill, outside);
  return returns * std::pow(derivative(fill, outside, true), 2) +
         (1.0 - returns) * std::pow(derivative(fill, outside, false), 2);
}

// A fit in units of radians and radii.
struct Fit {
  Vector6 gradient = Vector6::Zero();
  Matrix6 information = Matrix6::Zero();
  double length_rays = 0.0;
};

SilhouetteFit fit_of(const Body& body, const FrameView& view, const Pose& pose,
                     std::int32_t sigma_q8 = kSigma_q8, int every = 1) {
  const MeshSection section(body);
  const auto surface = std::make_unique<Rendering>();
  render(section.mesh(), view, pose, *surface, surface->budget);
  SilhouetteTable table;
  make_silhouette_table(static_cast<std::uint32_t>(std::lround(kFill * 65536.0)), table);
  SilhouetteFit fit;
  fit_silhouette(section.mesh(), view, pose, *surface, table, sigma_q8, fit, surface->budget, every);
  return fit;
}
Fit in_units(const SilhouetteFit& fit, const FrameView& view, std::int32_t sigma_q8 = kSigma_q8) {
  const double scale = static_cast<double>(view.rays_per_radius_q8) / sigma_q8;
  Fit result;
  for (int i = 0; i < kUnknowns; ++i) {
    result.gradient(i) =
        static_cast<double>(fit.equations.gradient[static_cast<std::size_t>(i)]) / std::exp2(26) * scale;
    for (int k = 0; k <= i; ++k)
      result.information(i, k) = result.information(k, i) =
          static_cast<double>(fit.equations.information[element(i, k)]) / std::exp2(28) * scale * scale;
  }
  result.length_rays = static_cast<double>(fit.length_q8) / 256.0;
  return result;
}

bool equal(const SilhouetteFit& a, const SilhouetteFit& b) {
  return a.equations.information == b.equations.information && a.equations.gradient == b.equations.gradient &&
         a.length_q8 == b.length_q8;
}

// The four edges of plate() on the screen, with the points in space that they join.
struct PlateEdge {
  std::array<Eigen::Vector3d, 2> ends_m;  // in the LRF
  std::array<Eigen::Vector2d, 2> places;
  Eigen::Vector2d out;
};
std::array<PlateEdge, 4> edges_of_plate(const ExactPose& pose) {
  const Body body = rounded(plate());
  std::array<PlateEdge, 4> edges;
  for (std::size_t i = 0; i < 4; ++i) {
    PlateEdge& edge = edges[i];
    for (std::size_t k = 0; k < 2; ++k) {
      edge.ends_m[k] = pose.r_lrf_trf * body.corners[(i + k) % 4] + pose.origin_m;
      edge.places[k] = on_screen(kSensor, edge.ends_m[k]);
    }
    const Eigen::Vector2d along = (edge.places[1] - edge.places[0]).normalized();
    edge.out = {along.y(), -along.x()};
    if (edge.out.dot(edge.places[0] - on_screen(kSensor, pose.origin_m)) < 0.0) edge.out = -edge.out;
  }
  return edges;
}
// From the silhouette of the plate, outwards [rays].
double distance_of(const std::array<PlateEdge, 4>& edges, int row, int column) {
  double distance = -1e9;
  for (const PlateEdge& edge : edges)
    distance = std::max(distance, edge.out.dot(Eigen::Vector2d(column + 0.5, row + 0.5) - edge.places[0]));
  return distance;
}

// Change of a point's place by a turn about the TRF's origin [rad] or a move of it [radii], per unit.
Eigen::Vector2d change_of_place(const Eigen::Vector3d& point_m, const ExactPose& pose, int unknown) {
  constexpr double kStep = 1e-5;
  const auto place = [&](double step) {
    Eigen::Vector3d by = Eigen::Vector3d::Zero();
    by(unknown % 3) = step;
    if (unknown >= 3) return on_screen(kSensor, point_m + plate().radius_m * by);
    const Eigen::Matrix3d turn = moved({}, by, {0.0, 0.0, 0.0}).r_lrf_trf;
    return on_screen(kSensor, turn * (point_m - pose.origin_m) + pose.origin_m);
  };
  return (place(kStep) - place(-kStep)) / (2.0 * kStep);
}

// The fit of the plate by its definition: along each edge, the rays across it. With many more places than the
// flight code looks at.
Fit expected_fit(const ExactPose& pose, const FrameView& view) {
  constexpr int kReach = 4;  // of 3 sigma and a ray
  constexpr int kPlacesPerRay = 8;
  const double sigma_rays = kSigma_q8 / 256.0;
  Fit fit;
  for (const PlateEdge& edge : edges_of_plate(pose)) {
    const double length = (edge.places[1] - edge.places[0]).norm();
    const int places = static_cast<int>(std::lround(kPlacesPerRay * length));
    for (int i = 0; i < places; ++i) {
      const double part = (i + 0.5) / places;
      const Eigen::Vector2d place = (1.0 - part) * edge.places[0] + part * edge.places[1];
      const double depth_m = 1.0 / ((1.0 - part) / edge.ends_m[0].y() + part / edge.ends_m[1].y());
      const Eigen::Vector3d point_m = depth_m * ray(kSensor, place.y() - 0.5, place.x() - 0.5);
      Vector6 row;
      for (int k = 0; k < kUnknowns; ++k) row(k) = edge.out.dot(change_of_place(point_m, pose, k));
      row /= sigma_rays;
      for (int k = -kReach; k <= kReach; ++k) {
        const Eigen::Vector2d across = (place + k * edge.out).array().floor();
        const int ray_row = static_cast<int>(across.y()), ray_column = static_cast<int>(across.x());
        if (ray_row < 0 || ray_column < 0 || ray_row >= view.rays || ray_column >= view.rays) continue;
        const double outside = edge.out.dot(across + Eigen::Vector2d(0.5, 0.5) - place) / sigma_rays;
        const bool is_hit = view.is_returned(ray_row, ray_column);
        fit.gradient += length / places * derivative(kFill, outside, is_hit) * row;
        fit.information += length / places * fisher_information(kFill, outside) * row * row.transpose();
      }
    }
    fit.length_rays += length;
  }
  return fit;
}

// Returns as the likelihood has them, for the plate at `pose`.
void show_plate(const ExactPose& pose, double sigma_rays, Random& random, FrameView& view) {
  const auto edges = edges_of_plate(pose);
  std::vector<std::int16_t> rays;
  for (int row = 0; row < kSensor.rays; ++row) {
    for (int column = 0; column < kSensor.rays; ++column) {
      const double returns = probability_of_return(kFill, distance_of(edges, row, column) / sigma_rays);
      rays.push_back(random.happens(returns) ? std::int16_t{0} : kMissed);
    }
  }
  show(rays, view);
}

void hide(int row, int column, FrameView& view) {
  const std::uint32_t bit = 0x8000'0000U >> (column % 32);
  const auto at_row = static_cast<std::size_t>(row), at_word = static_cast<std::size_t>(column / 32);
  view.returned.rows[at_row][at_word] &= ~bit;
  view.hidden.rows[at_row][at_word] |= bit;
}

ExactPose random_plate_pose(Random& random) {
  const Eigen::Vector3d turn_rad = {random.uniform(-0.7, 0.7), random.uniform(-0.5, 0.5),
                                    random.uniform(-0.7, 0.7)};
  const Eigen::Vector3d move_m = random.vector(0.1);
  return moved({Eigen::Matrix3d::Identity(), {0.0, kDepth_m, 0.0}}, turn_rad, move_m);
}

TEST(SilhouetteTable, IsTheDerivativeOfTheLogarithmOfTheProbability) {
  for (const double fill : {0.5, 0.7, 0.9, 0.99}) {
    SilhouetteTable table{};
    make_silhouette_table(static_cast<std::uint32_t>(std::lround(fill * 65536.0)), table);
    for (int i = 0; i < SilhouetteTable::kSteps; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double outside =
          static_cast<double>(i - SilhouetteTable::kSteps / 2) / SilhouetteTable::kPerSigma;
      EXPECT_NEAR(table.if_hit[at] / 4096.0, derivative(fill, outside, true), 1.5 / 4096.0) << i;
      EXPECT_NEAR(table.if_missed[at] / 4096.0, derivative(fill, outside, false), 1.5 / 4096.0) << i;
      EXPECT_NEAR(table.information[at] / 4096.0, fisher_information(fill, outside), 1.5 / 4096.0) << i;
    }
  }
}

TEST(SilhouetteTable, FillIsLimitedToHalfAnd99Percent) {
  const auto table_of = [](std::uint32_t fill_q16) {
    SilhouetteTable table{};
    make_silhouette_table(fill_q16, table);
    return table;
  };
  EXPECT_EQ(table_of(0).if_missed, table_of(32'768).if_missed);
  EXPECT_EQ(table_of(0).information, table_of(32'768).information);
  EXPECT_EQ(table_of(65'536).if_missed, table_of(64'880).if_missed);
  EXPECT_EQ(table_of(0xFFFFFFFF).information, table_of(64'880).information);
  EXPECT_NE(table_of(64'000).if_missed, table_of(65'536).if_missed);
}

// Relative to the standard deviation of a derivative, the root of its information. A single fit differs by
// the places that it looks at and by those that it leaves out next to a corner; on average it does not.
TEST(SilhouetteFit, IsTheDerivativeOfTheLikelihoodOfAPlate) {
  Random random(1);
  const auto view = empty_view(kSensor, kDepth_m, plate().radius_m);
  const int count = trials(40);
  Vector6 products = Vector6::Zero(), squares = Vector6::Zero(), differences = Vector6::Zero();
  for (int i = 0; i < count; ++i) {
    const Pose pose = fixed(random_plate_pose(random));
    // The frame shows the plate half a ray away.
    const Eigen::Vector3d turn_rad = random.vector(0.01), move_m = random.vector(0.03);
    show_plate(moved(exact(pose), turn_rad, move_m), 0.3, random, *view);
    const Fit expected = expected_fit(exact(pose), *view);
    const Fit found = in_units(fit_of(plate(), *view, pose), *view);
    EXPECT_NEAR(found.length_rays, expected.length_rays, 0.05 * expected.length_rays) << i;
    const Vector6 sigma = expected.information.diagonal().cwiseSqrt();
    const Matrix6 inverse = sigma.cwiseInverse().asDiagonal();
    EXPECT_LT((inverse * (found.information - expected.information) * inverse).cwiseAbs().maxCoeff(), 0.1)
        << i;
    const Vector6 found_gradient = inverse * found.gradient, expected_gradient = inverse * expected.gradient;
    EXPECT_LT((found_gradient - expected_gradient).cwiseAbs().maxCoeff(), 2.0) << i;
    products += found_gradient.cwiseProduct(expected_gradient);
    squares += expected_gradient.cwiseAbs2();
    differences += (found_gradient - expected_gradient) / count;
  }
  for (int k = 0; k < kUnknowns; ++k) {
    EXPECT_NEAR(products(k) / squares(k), 1.0, 0.05 + 0.3 / std::sqrt(count)) << k;
    EXPECT_NEAR(differences(k), 0.0, 0.1 + 2.0 / std::sqrt(count)) << k;
  }
}

// In frames as the likelihood has them the gradient is 0 on average, with the information as its variance.
// The corners, where two edges look at the same rays, are what remains.
TEST(SilhouetteFit, IsZeroOnAverageAtTheTruePose) {
  Random random(2);
  const auto view = empty_view(kSensor, kDepth_m, plate().radius_m);
  const int count = trials(160);
  Vector6 sum = Vector6::Zero(), squares = Vector6::Zero();
  for (int i = 0; i < count; ++i) {
    const Pose pose = fixed(random_plate_pose(random));
    show_plate(exact(pose), kSigma_q8 / 256.0, random, *view);
    const Fit found = in_units(fit_of(plate(), *view, pose), *view);
    const Vector6 ratio = found.gradient.cwiseQuotient(Vector6(found.information.diagonal().cwiseSqrt()));
    sum += ratio;
    squares += ratio.cwiseAbs2();
  }
  for (int k = 0; k < kUnknowns; ++k) {
    const double corners = k == 4 ? 0.5 : 0.0;  // pull the plate away from the sensor
    EXPECT_NEAR(sum(k) / count, 0.0, corners + 4.5 / std::sqrt(count)) << k;
    EXPECT_NEAR(squares(k) / count, 1.0, 0.35 + 6.5 / std::sqrt(count)) << k;
  }
}

// Half of the rays, counted twice: the same information, and a gradient with twice its variance.
TEST(SilhouetteFit, OfEverySecondLineIsThatOfAllOnAverage) {
  Random random(9);
  const auto view = empty_view(kSensor, kDepth_m, plate().radius_m);
  const int count = trials(160);
  Vector6 squares = Vector6::Zero(), sum = Vector6::Zero();
  for (int i = 0; i < count; ++i) {
    const Pose pose = fixed(random_plate_pose(random));
    show_plate(exact(pose), kSigma_q8 / 256.0, random, *view);
    const Fit all = in_units(fit_of(plate(), *view, pose), *view);
    const Fit half = in_units(fit_of(plate(), *view, pose, kSigma_q8, 2), *view);
    EXPECT_NEAR(half.length_rays, all.length_rays, 0.05 * all.length_rays) << i;
    const Vector6 sigma = all.information.diagonal().cwiseSqrt();
    const Matrix6 inverse = sigma.cwiseInverse().asDiagonal();
    EXPECT_LT((inverse * (half.information - all.information) * inverse).cwiseAbs().maxCoeff(), 0.1) << i;
    const Vector6 difference = (half.gradient - all.gradient).cwiseQuotient(sigma);
    sum += difference;
    squares += difference.cwiseAbs2();
  }
  for (int k = 0; k < kUnknowns; ++k) {
    EXPECT_NEAR(sum(k) / count, 0.0, 0.1 + 4.5 / std::sqrt(count)) << k;
    EXPECT_NEAR(squares(k) / count, 1.0, 0.35 + 6.5 / std::sqrt(count)) << k;
  }
}

TEST(SilhouetteFit, PointsToWhereTheSilhouetteIs) {
  Random random(3);
  const auto view = empty_view(kSensor, kDepth_m, plate().radius_m);
  const ExactPose start{Eigen::Matrix3d::Identity(), {0.0, kDepth_m, 0.0}};
  const double by_m = 0.1;
  for (int i = 0; i < 6; ++i) {
    const double sign = i % 2 == 0 ? 1.0 : -1.0;
    Eigen::Vector3d move_m = Eigen::Vector3d::Zero();
    move_m(i / 2) = sign * (i / 2 == 1 ? 10.0 : 1.0) * by_m;
    show_plate(moved(start, {0.0, 0.0, 0.0}, move_m), 0.1, random, *view);
    EXPECT_GT(sign * in_units(fit_of(plate(), *view, fixed(start)), *view).gradient(3 + i / 2), 0.0) << i;
  }
}

TEST(SilhouetteFit, EdgesInsideTheSilhouetteAddNothing) {
  Random random(4);
  const auto view = empty_view(kSensor, kDepth_m, plate().radius_m);
  Body in_front = plate();
  in_front.add_plate(-0.5, 0.7, -0.6, 0.4, -0.5);  // in no view of these tests over the plate's edge
  Body folded = plate();                           // as it is, but of more triangles
  folded.corners.push_back({0.0, 0.0, 0.0});
  folded.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  for (int i = 0; i < trials(40); ++i) {
    const Pose pose = fixed(random_plate_pose(random));
    show_plate(exact(pose), 1.0, random, *view);
    const SilhouetteFit alone = fit_of(plate(), *view, pose);
    ASSERT_GT(alone.length_q8, 50 * 256);
    EXPECT_TRUE(equal(fit_of(in_front, *view, pose), alone)) << i;
    EXPECT_NEAR(static_cast<double>(fit_of(folded, *view, pose).length_q8),
                static_cast<double>(alone.length_q8), 1.0)
        << i;
  }
}

TEST(SilhouetteFit, HiddenEdgesAddNothing) {
  Random random(5);
  const auto view = empty_view(kSensor, kDepth_m, plate().radius_m);
  Body behind = plate();
  behind.add_plate(-0.5, 0.7, -0.6, 0.4, 0.5);
  for (int i = 0; i < trials(40); ++i) {
    const Pose pose = fixed(random_plate_pose(random));
    show_plate(exact(pose), 1.0, random, *view);
    EXPECT_TRUE(equal(fit_of(behind, *view, pose), fit_of(plate(), *view, pose))) << i;
  }
}

// A step: the edge between its tread and its riser is never on the silhouette, though the silhouette bends
// there.
TEST(SilhouetteFit, ConcaveEdgesAddNothing) {
  Body step;
  step.radius_m = 3.0;
  for (const double x : {-1.0, 1.0})
    for (const auto& [y, z] : std::initializer_list<std::pair<double, double>>{
             {-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {0.0, 1.0}, {0.0, 0.0}, {-1.0, 0.0}})
      step.corners.emplace_back(x, y, z);
  constexpr int kConcave = 4;
  for (int i = 0; i < 6; ++i) {
    const int next = (i + 1) % 6;
    step.triangles.push_back({i, next, next + 6});
    step.triangles.push_back({i, next + 6, i + 6});
  }
  for (const int first : {0, 6}) {
    for (const auto& [a, b, c] :
         {std::array{0, 1, 5}, std::array{1, 4, 5}, std::array{1, 2, 4}, std::array{2, 3, 4}})
      step.triangles.push_back({first + a, first + b, first + c});
  }
  MeshSection section(step);
  MeshSection without(step);
  // The concave edge becomes one without a length.
  const SurfaceMesh mesh = without.mesh();
  const std::size_t edges_at =
      without.bytes().size() - std::size_t{8} * static_cast<std::size_t>(mesh.edges());
  int removed = 0;
  for (int i = 0; i < mesh.edges(); ++i) {
    const SurfaceMesh::Edge edge = mesh.edge(i);
    if (edge.first != kConcave || edge.second != kConcave + 6) continue;
    without.bytes()[edges_at + std::size_t{8} * static_cast<std::size_t>(i) + 2] = kConcave;
    ++removed;
  }
  ASSERT_EQ(removed, 1);
  Random random(6);
  const auto view = empty_view(kSensor, kDepth_m, step.radius_m);
  show_random_returns(random, *view);
  SilhouetteTable table;
  make_silhouette_table(60'000, table);
  const auto surface = std::make_unique<Rendering>();
  for (int i = 0; i < trials(100); ++i) {
    const Pose pose = fixed({random.rotation(), {0.0, kDepth_m, 0.0}});
    SilhouetteFit with_edge, without_edge;
    render(section.mesh(), *view, pose, *surface, surface->budget);
    fit_silhouette(section.mesh(), *view, pose, *surface, table, kSigma_q8, with_edge, surface->budget);
    fit_silhouette(without.mesh(), *view, pose, *surface, table, kSigma_q8, without_edge, surface->budget);
    ASSERT_GT(with_edge.length_q8, 0);
    ASSERT_TRUE(equal(with_edge, without_edge)) << i;
  }
}

TEST(SilhouetteFit, HiddenRaysAddNothing) {
  Random random(7);
  const auto view = empty_view(kSensor, kDepth_m, plate().radius_m);
  const ExactPose pose{Eigen::Matrix3d::Identity(), {0.0, kDepth_m, 0.0}};
  show_plate(pose, 1.0, random, *view);
  const SilhouetteFit all = fit_of(plate(), *view, fixed(pose));
  for (int row = 0; row < kSensor.rays; ++row) {
    for (int column = kSensor.rays / 2; column < kSensor.rays; ++column) hide(row, column, *view);
  }
  const SilhouetteFit half = fit_of(plate(), *view, fixed(pose));
  EXPECT_NEAR(static_cast<double>(half.length_q8), static_cast<double>(all.length_q8) / 2.0, 3.0 * 256.0);
  // What the hidden half says does not matter, and the left edge only pulls to the right or to the left.
  show_all(kHidden, *view);
  const SilhouetteFit none = fit_of(plate(), *view, fixed(pose));
  EXPECT_TRUE(equal(none, SilhouetteFit()));
}

TEST(SilhouetteFit, IsEmptyWithoutASilhouette) {
  const auto view = empty_view(kSensor, kDepth_m, plate().radius_m);
  const auto surface = std::make_unique<Rendering>();
  SilhouetteTable table;
  make_silhouette_table(60'000, table);
  const Pose pose = fixed({Eigen::Matrix3d::Identity(), {0.0, kDepth_m, 0.0}});
  render(SurfaceMesh(), *view, pose, *surface, surface->budget);
  SilhouetteFit fit;
  fit.length_q8 = 1;
  fit_silhouette(SurfaceMesh(), *view, pose, *surface, table, kSigma_q8, fit, surface->budget);
  EXPECT_TRUE(equal(fit, SilhouetteFit()));
  const Pose behind = fixed({Eigen::Matrix3d::Identity(), {0.0, -kDepth_m, 0.0}});
  EXPECT_TRUE(equal(fit_of(plate(), *view, behind), SilhouetteFit()));
}

// Parts of the silhouette that are out of view are not looked at, at any width of the likelihood.
TEST(SilhouetteFit, SilhouetteOutOfViewAddsNothing) {
  Random random(8);
  const double edge_m = kDepth_m * kSensor.tan_half_fov();
  const auto view = empty_view(kSensor, kDepth_m, plate().radius_m);
  for (const std::int32_t sigma_q8 : {16, 40, 256, 1024}) {
    for (int i = 0; i < trials(16); ++i) {
      const ExactPose pose{
          random.rotation(),
          {random.uniform(-1.5, 1.5) * edge_m, kDepth_m, random.uniform(-1.5, 1.5) * edge_m}};
      show_random_returns(random, *view);
      double length_rays = 0.0;  // of the parts in view, and a ray beyond at each end
      for (const PlateEdge& edge : edges_of_plate(pose)) {
        for (double part = 0.0005; part < 1.0; part += 0.001) {
          const Eigen::Vector2d place = (1.0 - part) * edge.places[0] + part * edge.places[1];
          const bool is_in_view = place.minCoeff() > -2.0 && place.maxCoeff() < kSensor.rays + 2.0;
          if (is_in_view) length_rays += 0.001 * (edge.places[1] - edge.places[0]).norm();
        }
      }
      const SilhouetteFit fit = fit_of(plate(), *view, fixed(pose), sigma_q8);
      EXPECT_LE(static_cast<double>(fit.length_q8) / 256.0, length_rays + 4.0);
    }
  }
}

}  // namespace
}  // namespace tumblesight::gnc
