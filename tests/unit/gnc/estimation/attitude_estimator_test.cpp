#include "gnc/estimation/attitude_estimator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <vector>

#include "tests/support/test_models.hpp"
#include "tests/support/trials.hpp"
#include "tests/unit/gnc/rcnn/reference_network.hpp"
#include "tests/unit/gnc/rcnn/reference_track.hpp"

namespace tumblesight::gnc {
namespace {

template <class N>
std::unique_ptr<AttitudeEstimator<N>> loaded(unsigned seed) {
  auto estimator = std::make_unique<AttitudeEstimator<N>>();
  const std::vector<std::uint8_t>& image = lasting_model_image<N>(seed);
  EXPECT_EQ(estimator->load(image.data(), image.size(), "test_craft"), ModelStatus::kOk);
  return estimator;
}

std::unique_ptr<AttitudeEstimator<Float32>> loaded_with(const NetworkWeights<Float32>& weights) {
  std::vector<std::uint8_t> image(kModelImageSize<Float32>);
  EXPECT_EQ(write_model_image<Float32>(test_header(), weights, image.data(), image.size()), image.size());
  auto estimator = std::make_unique<AttitudeEstimator<Float32>>();
  EXPECT_EQ(estimator->load(image.data(), image.size(), nullptr), ModelStatus::kOk);
  return estimator;
}

// Bit for bit.
void expect_same(const AttitudeEstimate& a, const AttitudeEstimate& b) {
  EXPECT_EQ(a.q_lrf_trf, b.q_lrf_trf);
  EXPECT_EQ(a.predicted_error_urad, b.predicted_error_urad);
  EXPECT_EQ(a.q_lrf_trf_single_frame, b.q_lrf_trf_single_frame);
  EXPECT_EQ(a.predicted_error_single_frame_urad, b.predicted_error_single_frame_urad);
  EXPECT_EQ(a.frames_since_reset, b.frames_since_reset);
}

void expect_unit(const AttitudeEstimate& estimate) {
  EXPECT_NEAR(to_double(estimate.q_lrf_trf).norm(), 1.0, 2e-9);
  EXPECT_NEAR(to_double(estimate.q_lrf_trf_single_frame).norm(), 1.0, 2e-9);
  EXPECT_GE(estimate.q_lrf_trf[0], 0);
  EXPECT_GE(estimate.q_lrf_trf_single_frame[0], 0);
  EXPECT_LE(estimate.predicted_error_urad, kPi_urad);
  EXPECT_LE(estimate.predicted_error_single_frame_urad, kPi_urad);
}

double angle_between(const QuaternionQ30& q, const Eigen::Matrix3d& r) {
  return to_double(q).angularDistance(Eigen::Quaterniond(r));
}

double largest_difference(const float* flight, const std::vector<double>& reference) {
  double largest = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    largest = std::max(largest, std::fabs(flight[i] - reference[i]));
  }
  return largest;
}

// Images of blobs that change slowly, in changing view frames.
DepthImage sequence_image(unsigned frame) {
  DepthImage image = random_depth_image(70);
  const DepthImage other = random_depth_image(71);
  for (int i = 0; i < DepthImage::kCells; ++i) {
    const int difference = other.depth[i] - image.depth[i];
    image.depth[i] = static_cast<std::uint16_t>(image.depth[i] + difference * static_cast<int>(frame) / 25);
  }
  const float angle = 0.02F * static_cast<float>(frame % 5);
  const Eigen::AngleAxisf view(angle, Eigen::Vector3f(0.6F, 0.0F, 0.8F));
  image.r_lrf_view = converted<Fixed>(Eigen::Matrix3f(view.toRotationMatrix()));
  return image;
}

template <class N>
class EstimatorOf : public testing::Test {};
using BothNumerics = testing::Types<FixedPoint, Float32>;
TYPED_TEST_SUITE(EstimatorOf, BothNumerics);

// Verifies TS-NUM-090.
TEST(AttitudeEstimator, FollowsTheDoubleReferenceOverASequence) {
  int means_taken = 0, rates_corrected = 0;
  constexpr std::array<unsigned, 3> kSeeds{62, 66, 68};
  constexpr int kSequences = trials(kSeeds.size());
  for (int sequence = 0; sequence < kSequences; ++sequence) {
    const unsigned seed = kSeeds[sequence];
    auto weights = std::make_unique<NetworkWeights<Float32>>();
    fill_random(*weights, seed);
    ReferenceNetwork network(*weights);
    ReferenceTrack track(converted<float>(test_header().inertia.tensor_trf).cast<double>());
    const auto estimator = loaded<Float32>(seed);
    for (unsigned frame = 0; frame < 14; ++frame) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", frame " << frame);
      const DepthImage image = sequence_image(frame);
      const ReferenceNetwork::Frame frame_output = network.infer_frame(image);
      track.observe(frame_output.output, converted<float>(image.r_lrf_view).cast<double>());
      track.advance(network.infer_sequence(track.lstm_input(frame_output.features)));

      AttitudeEstimate estimate;
      AttitudeEstimator<Float32>::State state;
      estimator->step(image, estimate);
      estimator->save(state);
      EXPECT_LT(largest_difference(state.lstm.h.data(), network.h), 5e-4);
      EXPECT_LT(largest_difference(state.lstm.c.data(), network.c), 5e-4);
      for (int motion_model = 0; motion_model < kMotionModels; ++motion_model) {
        const Motion<float>& motion = state.track.motion[motion_model];
        EXPECT_LT((motion.r_lrf_trf.cast<double>() - track.motion[motion_model].attitude).norm(), 5e-4)
            << motion_model;
        EXPECT_LT((motion.rate_lrf.cast<double>() - track.motion[motion_model].rate).norm(), 5e-4)
            << motion_model;
        EXPECT_NEAR(state.track.log_likelihood[motion_model], track.log_likelihood[motion_model], 0.02)
            << motion_model;
      }
      EXPECT_LT(angle_between(estimate.q_lrf_trf, track.motion[track.motion_model()].attitude), 5e-4);
      EXPECT_LT(angle_between(estimate.q_lrf_trf_single_frame, track.single_frame()), 5e-5);
      EXPECT_NEAR(1e-6 * estimate.predicted_error_urad, track.error_rad, 5e-4);
      EXPECT_NEAR(1e-6 * estimate.predicted_error_single_frame_urad, track.single_frame_error_rad(), 5e-5);
      EXPECT_EQ(estimate.frames_since_reset, frame + 1);
    }
    means_taken += track.means_taken;
    rates_corrected += track.rates_corrected;
  }
  // The sequences exercise the track. A single random network may not: one that always chooses an attitude of
  // 60 degrees or more from the predicted one never corrects a rate.
  EXPECT_GT(means_taken, 16 * kSequences);
  EXPECT_GT(rates_corrected, 16 * kSequences);
}

// Verifies TS-IFC-090.
TEST(AttitudeEstimator, CrcOfTheStateCoversEveryMember) {
  const auto estimator = loaded<Float32>(37);
  AttitudeEstimate estimate;
  for (unsigned k = 0; k < 3; ++k) estimator->step(random_depth_image(k), estimate);
  AttitudeEstimator<Float32>::State state;
  estimator->save(state);
  std::vector<std::function<void(AttitudeEstimator<Float32>::State&)>> changes{
      [](auto& s) { ++s.track.frames; }};
  const auto add = [&changes](auto member, int count) {
    for (int i = 0; i < count; ++i) {
      changes.emplace_back([member, i](auto& s) { member(s)[i] = std::nextafter(member(s)[i], 9.0F); });
    }
  };
  add([](auto& s) { return s.lstm.h.data(); }, shape::kLstm);
  add([](auto& s) { return s.lstm.c.data(); }, shape::kLstm);
  add([](auto& s) { return s.track.log_likelihood.data(); }, kMotionModels);
  for (int motion_model = 0; motion_model < kMotionModels; ++motion_model) {
    add([motion_model](auto& s) { return s.track.motion[motion_model].r_lrf_trf.data(); }, 9);
    add([motion_model](auto& s) { return s.track.motion[motion_model].rate_lrf.data(); }, 3);
  }
  std::set<std::uint32_t> crcs{estimator->state_crc32()};
  for (const auto& change : changes) {
    AttitudeEstimator<Float32>::State changed = state;
    change(changed);
    estimator->restore(changed);
    EXPECT_TRUE(crcs.insert(estimator->state_crc32()).second);
  }
}

// Verifies TS-EST-110.
TEST(AttitudeEstimator, ExpectsAnErrorOfPiForANonFiniteAttitude) {
  auto weights = std::make_unique<NetworkWeights<Float32>>();
  fill_random(*weights, 38);
  // The hypotheses overflow, while the expected errors are small.
  layer_weights<kCnnOutputLayer>(*weights).bias.fill(3e38F);
  layer_weights<kCnnOutputLayer>(*weights).weight.fill(3e38F);
  layer_weights<kCnnOutputLayer>(*weights).bias[shape::kOutput - 1] = -1e38F;
  layer_weights<kHeadOutputLayer>(*weights).bias[shape::kHeadOutput - 1] = -30.0F;
  const auto estimator = loaded_with(*weights);
  AttitudeEstimate estimate;
  for (unsigned k = 0; k < 3; ++k) {
    estimator->step(random_depth_image(k), estimate);
    expect_unit(estimate);
    EXPECT_EQ(estimate.q_lrf_trf, kIdentityQ30);
    EXPECT_EQ(estimate.predicted_error_urad, kPi_urad);
    EXPECT_EQ(estimate.predicted_error_single_frame_urad, kPi_urad);
  }
}

// docs/numerics.md, in double precision. Innovation: the angle between predicted and estimated attitude.
double expected_error(double network_rad, double misfit, double innovation_rad, double second_share) {
  const double share = network_rad / M_PI;
  const double innovation = std::min(1.0, (1.0 - std::cos(innovation_rad)) / (1.0 - std::cos(M_PI / 6.0)));
  const double sum =
      0.82 * std::log(share / (1.0 - share)) + 13.0 * misfit + 1.6 * innovation + 2.3 * second_share - 5.5;
  return network_rad + (1.84 - network_rad) / (1.0 + std::exp(-sum));
}

// Verifies TS-EST-192. With a target of one point, which explains no return, and without a surface.
TEST(AttitudeEstimator, TakesTheEvidenceOfEachFrameIntoTheExpectedError) {
  const auto weights = std::make_unique<NetworkWeights<FixedPoint>>();
  const std::vector<std::uint8_t>& without = lasting_model_image<FixedPoint>(31);
  ModelHeader header;
  ASSERT_EQ(read_model_image<FixedPoint>(without.data(), without.size(), nullptr, header, *weights),
            ModelStatus::kOk);
  std::vector<std::uint8_t> surface(SurfaceModel::kBytes), with(without.size());
  surface[0] = 1;
  ASSERT_EQ(write_model_image<FixedPoint>(header, *weights, with.data(), with.size(), {surface.data()}),
            with.size());
  const auto network = std::make_unique<AttitudeEstimator<FixedPoint>>();
  const auto checked = std::make_unique<AttitudeEstimator<FixedPoint>>();
  ASSERT_EQ(network->load(without.data(), without.size(), nullptr), ModelStatus::kOk);
  ASSERT_EQ(checked->load(with.data(), with.size(), nullptr), ModelStatus::kOk);
  bool second_counts = false;
  for (unsigned k = 0; k < 12; ++k) {
    AttitudeEstimate expected, found;
    network->step(sequence_image(k), expected);
    checked->step(sequence_image(k), found);
    ASSERT_EQ(found.q_lrf_trf, expected.q_lrf_trf);
    EXPECT_EQ(found.explained.outliers, kWholeShare);
    const double cosine = std::abs(to_double(found.q_lrf_trf).dot(to_double(found.q_lrf_trf_predicted)));
    const double innovation_rad = found.has_prediction ? 2.0 * std::acos(std::min(1.0, cosine)) : 0.0;
    const double odds = 1e-6 * found.second_odds_ppm;
    EXPECT_NEAR(1e-6 * found.predicted_error_urad,
                expected_error(1e-6 * expected.predicted_error_urad, misfit_of(found.explained) / 65536.0,
                               innovation_rad, odds / (1.0 + odds)),
                1e-4)
        << k;
    second_counts |= odds > 0.01;
  }
  EXPECT_TRUE(second_counts);
}

// Verifies TS-MEM-080. The mesh is read in the image; no result depends on it yet.
TEST(AttitudeEstimator, HasTheMeshOfTheLoadedImageAndChecksItWithItsConstants) {
  const auto weights = std::make_unique<NetworkWeights<FixedPoint>>();
  const std::vector<std::uint8_t>& without = lasting_model_image<FixedPoint>(31);
  ModelHeader header;
  ASSERT_EQ(read_model_image<FixedPoint>(without.data(), without.size(), nullptr, header, *weights),
            ModelStatus::kOk);
  std::vector<std::uint8_t> mesh(SurfaceMesh::kMaxBytes), with(without.size());
  mesh[0] = 3;   // vertices
  mesh[2] = 1;   // triangle
  mesh[6] = 12;  // mm
  mesh[28] = 2;  // its second corner
  ASSERT_EQ(write_model_image<FixedPoint>(header, *weights, with.data(), with.size(), {nullptr, mesh.data()}),
            with.size());
  const auto estimator = std::make_unique<AttitudeEstimator<FixedPoint>>();
  EXPECT_FALSE(estimator->mesh().is_known());
  ASSERT_EQ(estimator->load(without.data(), without.size(), nullptr), ModelStatus::kOk);
  EXPECT_FALSE(estimator->mesh().is_known());
  ASSERT_EQ(estimator->load(with.data(), with.size(), nullptr), ModelStatus::kOk);
  EXPECT_EQ(estimator->mesh().triangles(), 1);
  EXPECT_EQ(estimator->mesh().error_mm(), 12);
  EXPECT_EQ(estimator->mesh().triangle(0), (SurfaceMesh::Triangle{0, 2, 0}));

  const std::uint32_t constants = estimator->constants_crc32();
  const_cast<SurfaceMesh&>(estimator->mesh()) = SurfaceMesh();
  EXPECT_NE(estimator->constants_crc32(), constants);
  estimator->reload(with.data());
  EXPECT_EQ(estimator->constants_crc32(), constants);
  EXPECT_EQ(estimator->mesh().triangles(), 1);
}

TYPED_TEST(EstimatorOf, ContinuesBitForBitAfterSaveAndRestore) {
  const auto estimator = loaded<TypeParam>(31);
  AttitudeEstimate estimate;
  for (unsigned k = 0; k < 3; ++k) estimator->step(random_depth_image(k), estimate);
  typename AttitudeEstimator<TypeParam>::State saved;
  estimator->save(saved);
  const std::uint32_t crc = estimator->state_crc32();

  std::vector<AttitudeEstimate> first(3);
  for (unsigned k = 0; k < 3; ++k) estimator->step(random_depth_image(10 + k), first[k]);
  EXPECT_NE(estimator->state_crc32(), crc);

  const auto other = loaded<TypeParam>(31);
  for (AttitudeEstimator<TypeParam>* restored : {estimator.get(), other.get()}) {
    restored->restore(saved);
    EXPECT_EQ(restored->state_crc32(), crc);
    for (unsigned k = 0; k < 3; ++k) {
      restored->step(random_depth_image(10 + k), estimate);
      expect_same(estimate, first[k]);
    }
  }
}

// Verifies TS-EST-160.
TYPED_TEST(EstimatorOf, StartsOverAfterReset) {
  const auto estimator = loaded<TypeParam>(34);
  AttitudeEstimate first, second, again;
  estimator->step(random_depth_image(1), first);
  EXPECT_EQ(first.frames_since_reset, 1U);
  estimator->step(random_depth_image(1), second);
  EXPECT_EQ(second.frames_since_reset, 2U);
  EXPECT_NE(second.q_lrf_trf, first.q_lrf_trf);  // memory matters
  EXPECT_EQ(second.q_lrf_trf_single_frame, first.q_lrf_trf_single_frame);
  estimator->reset();
  estimator->step(random_depth_image(1), again);
  expect_same(again, first);
}

// Verifies TS-EST-160.
TYPED_TEST(EstimatorOf, ResetsWhenAModelIsLoaded) {
  const auto estimator = loaded<TypeParam>(33);
  AttitudeEstimate first, estimate;
  estimator->step(random_depth_image(1), first);
  const std::vector<std::uint8_t>& image = lasting_model_image<TypeParam>(33);
  ASSERT_EQ(estimator->load(image.data(), image.size(), nullptr), ModelStatus::kOk);
  estimator->step(random_depth_image(1), estimate);
  expect_same(estimate, first);
}

// Verifies TS-IFC-050.
TYPED_TEST(EstimatorOf, HasNoModelUntilAGoodOneIsLoaded) {
  auto estimator = std::make_unique<AttitudeEstimator<TypeParam>>();
  EXPECT_FALSE(estimator->has_model());
  const std::vector<std::uint8_t> garbage(100, 0xA5);
  EXPECT_EQ(estimator->load(garbage.data(), garbage.size(), nullptr), ModelStatus::kBadMagic);
  EXPECT_FALSE(estimator->has_model());
}

// Verifies TS-LID-010, TS-LID-040.
TYPED_TEST(EstimatorOf, IsUnaffectedByRefusedFrames) {
  const auto disturbed = loaded<TypeParam>(34);
  const auto undisturbed = loaded<TypeParam>(34);
  AttitudeEstimate a, b;
  for (unsigned k = 0; k < 3; ++k) {
    ASSERT_EQ(disturbed->step(random_frame(k), a), FrameStatus::kOk);
    ASSERT_EQ(undisturbed->step(random_frame(k), b), FrameStatus::kOk);
    RangeImage empty = random_frame(k);
    empty.ranges.fill(0);
    RangeImage wrong_rays = random_frame(k);
    wrong_rays.rays = 200;
    RangeImage wrong_fov = random_frame(k);
    wrong_fov.fov_urad = 1;
    EXPECT_EQ(disturbed->step(empty, a), FrameStatus::kEmpty);
    EXPECT_EQ(disturbed->step(wrong_rays, a), FrameStatus::kBadRayCount);
    EXPECT_EQ(disturbed->step(wrong_fov, a), FrameStatus::kBadFov);
    expect_same(a, b);
    EXPECT_EQ(disturbed->state_crc32(), undisturbed->state_crc32());
  }
}

TYPED_TEST(EstimatorOf, FrameAndItsDepthImageGiveTheSameEstimate) {
  const auto estimator = loaded<TypeParam>(35);
  AttitudeEstimate from_frame, from_image;
  ASSERT_EQ(estimator->step(random_frame(1), from_frame), FrameStatus::kOk);
  const auto image = std::make_unique<DepthImage>();
  const auto scratch = std::make_unique<DepthImageScratch>();
  ASSERT_EQ(make_depth_image(random_frame(1), estimator->model().projection, *scratch, *image),
            FrameStatus::kOk);
  EXPECT_GT(std::count_if(image->depth.begin(), image->depth.end(), [](int depth) { return depth > 0; }),
            100);
  estimator->reset();
  estimator->step(*image, from_image);
  expect_same(from_image, from_frame);
}

// Verifies TS-EST-100.
TYPED_TEST(EstimatorOf, AlwaysGivesUnitQuaternions) {
  for (int trial = 0; trial < trials(6); ++trial) {
    const unsigned seed = 40 + trial;
    const auto estimator = loaded<TypeParam>(seed);
    AttitudeEstimate estimate;
    for (unsigned k = 0; k < 4; ++k) {
      estimator->step(k == 1 ? DepthImage{} : random_depth_image(seed + k), estimate);
      expect_unit(estimate);
    }
  }
}

// Verifies TS-EST-100.
TEST(AttitudeEstimator, GivesUnitQuaternionsForZeroAndForOverflowingWeights) {
  for (const float value : {0.0F, 1e30F, -1e30F, 3e38F}) {
    auto weights = std::make_unique<NetworkWeights<Float32>>();
    for_each_tensor(*weights, [value](const char*, const char*, auto& tensor) {
      for (std::size_t i = 0; i < tensor.size(); ++i) tensor[i] = i % 3 == 0 ? value : -0.5F * value;
    });
    const auto estimator = loaded_with(*weights);
    AttitudeEstimate estimate;
    for (unsigned k = 0; k < 3; ++k) {
      estimator->step(random_depth_image(k), estimate);
      expect_unit(estimate);
    }
  }
}

// Verifies TS-EST-100, TS-EST-160, TS-EST-170.
TEST(AttitudeEstimator, SurvivesADamagedStateAndForgetsItWhenReset) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const auto estimator = loaded<Float32>(36);
  AttitudeEstimate first, estimate;
  estimator->step(random_depth_image(1), first);
  AttitudeEstimator<Float32>::State damaged;
  estimator->save(damaged);
  damaged.lstm.h.fill(kNan);
  damaged.lstm.c.fill(std::numeric_limits<float>::infinity());
  for (const float value : {kNan, std::numeric_limits<float>::infinity(), 1e30F, 0.0F}) {
    for (Motion<float>& motion : damaged.track.motion) {
      motion.r_lrf_trf.setConstant(value);
      motion.rate_lrf.setConstant(-value);
    }
    estimator->restore(damaged);
    for (unsigned k = 0; k < 3; ++k) {
      estimator->step(random_depth_image(1), estimate);
      expect_unit(estimate);
    }
    estimator->reset();
    estimator->step(random_depth_image(1), estimate);
    expect_same(estimate, first);
  }
}

}  // namespace
}  // namespace tumblesight::gnc
