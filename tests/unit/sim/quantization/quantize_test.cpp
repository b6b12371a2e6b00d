// Quantization of a network with random weights on rendered sequences, and of the shipped NEAR model.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include "sim/quantization/quantize_file.hpp"
#include "sim/world/target/shipped_meshes.hpp"
#include "tests/support/sim_models.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kSequences = 12;

class QuantizeTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new TemporaryFolder;
    path = new std::string(folder->path("quantized.tsm"));
    report = new QuantizationReport(quantize_to_file(*random_float32_model(77), {make_near_shoemaker()},
                                                     kSequences, *path, [](std::uint64_t) { ++steps; }));
  }
  static void TearDownTestSuite() {
    delete folder;
    delete path;
    delete report;
  }
  static TemporaryFolder* folder;
  static std::string* path;
  static QuantizationReport* report;
  static inline int steps = 0;
};
TemporaryFolder* QuantizeTest::folder = nullptr;
std::string* QuantizeTest::path = nullptr;
QuantizationReport* QuantizeTest::report = nullptr;

// Verifies TS-TRN-020.
TEST_F(QuantizeTest, WritesAnImageThatTheFlightEstimatorLoads) {
  std::ifstream file(*path, std::ios::binary);
  const std::vector<std::uint8_t> image{std::istreambuf_iterator<char>(file),
                                        std::istreambuf_iterator<char>()};
  EXPECT_EQ(image.size(), report->size_bytes);
  const auto estimator = std::make_unique<gnc::AttitudeEstimator<gnc::FixedPoint>>();
  ASSERT_EQ(estimator->load(image.data(), image.size(), gnc::test_header().target.data()),
            gnc::ModelStatus::kOk);
  EXPECT_EQ(estimator->model().crc32, report->crc32);
  EXPECT_GT(gnc::surface_of<gnc::FixedPoint>(image.data()).points(), 1900U);
  EXPECT_GT(estimator->mesh().triangles(), 1500);
  EXPECT_EQ(estimator->mesh().error_mm(), gnc::SurfaceMesh(report->surface.mesh.data()).error_mm());
}

// Verifies TS-TRN-020.
TEST_F(QuantizeTest, KeepsTheSignalOfEveryLayer) {
  ASSERT_EQ(report->layers.size(), 8U);
  for (const LayerReport& layer : report->layers) {
    EXPECT_GT(layer.snr_db, 20.0) << layer.layer;
    EXPECT_LT(layer.saturated, 0.005) << layer.layer;
  }
}

// Verifies TS-TRN-020. Unlike random networks, trained ones have rare large activations. With scales chosen
// to hold the largest of them, the shipped NEAR's convolutions had a signal-to-noise ratio of only 19 dB.
TEST(QuantizeShipped, NearKeepsTheSignalOfEveryLayerBeforeTheHypotheses) {
  const auto model = read_float32_model(TUMBLESIGHT_SOURCE_DIR "/fsw/models/near_shoemaker.float32.tsm");
  const TemporaryFolder folder;
  const QuantizationReport report =
      quantize_to_file(*model, {make_near_shoemaker()}, 20, folder.path("near.tsm"), [](std::uint64_t) {});
  for (const LayerReport& layer : report.layers) {
    // The layers after the choice of a hypothesis are left out: that choice may differ between the numerics.
    if (gnc::layer_index(layer.layer.c_str()) >= gnc::kLstmLayer) continue;
    EXPECT_GT(layer.snr_db, 27.0) << layer.layer;
  }
  EXPECT_LT(report.difference.median_deg, 0.5);
}

ScenarioSettings with_effect(const std::string& effect) {
  ScenarioSettings seen;
  if (!effect.empty()) seen.effects = effect_ranges_from({effect});
  return seen;
}

// Depths of a calibration sequence, all frames.
std::vector<std::uint16_t> calibration_depths(const std::string& effect, std::uint64_t number) {
  const TriangleMesh mesh = make_near_shoemaker();
  const ScenarioSettings seen = with_effect(effect);
  const FlashLidar lidar(observed_bodies(seen.effects, mesh.name, mesh));
  std::vector<std::uint16_t> depths;
  for (const gnc::DepthImage& image : calibration_sequence({&lidar}, projection_of(mesh), number, seen))
    depths.insert(depths.end(), image.depth.begin(), image.depth.end());
  return depths;
}

// Verifies TS-TRN-020, TS-SIL-300. Effects on the sensor, on the body, on returns and on readings.
TEST(Calibration, FramesHaveTheEffects) {
  const auto filled = [](const std::vector<std::uint16_t>& depths) {
    return std::count_if(depths.begin(), depths.end(), [](std::uint16_t depth) { return depth != 0; });
  };
  const std::vector<std::uint16_t> plain = calibration_depths("", 0);
  EXPECT_LT(filled(calibration_depths("dropout=0.6", 0)), filled(plain));
  EXPECT_LT(filled(calibration_depths("lobe=60", 0)), filled(plain));
  EXPECT_LT(filled(calibration_depths("dead_pixels=0.5", 0)), filled(plain));
  EXPECT_NE(calibration_depths("panel_turn=30", 0), plain);
  EXPECT_EQ(calibration_depths("", 0), plain);
}

// Verifies TS-SIL-340. Sequences of one image see the whole range.
TEST(Calibration, SequencesDrawTheStrengthsOfARange) {
  const auto share_of_returns = [](std::uint64_t number) {
    const auto filled = [&](const char* effect) {
      const std::vector<std::uint16_t> depths = calibration_depths(effect, number);
      return static_cast<double>(std::count_if(depths.begin(), depths.end(), [](auto d) { return d != 0; }));
    };
    return filled("dropout=0.01:0.95") / filled("");
  };
  std::vector<double> shares;
  for (std::uint64_t number = 0; number < 8; ++number) shares.push_back(share_of_returns(number));
  const auto [least, most] = std::minmax_element(shares.begin(), shares.end());
  EXPECT_LT(*least, 0.6);
  EXPECT_GT(*most, 0.75);
}

std::uint32_t crc32_with(const std::string& effect, const TemporaryFolder& folder) {
  return quantize_to_file(
             *random_float32_model(77), {make_near_shoemaker()}, 10, folder.path("near.tsm"),
             [](std::uint64_t) {}, with_effect(effect))
      .crc32;
}

// Verifies TS-TRN-020.
TEST(Calibration, SequencesTakeTurnsAmongSetsOfEffects) {
  const TemporaryFolder folder;
  const auto crc32_of = [&](const std::vector<std::string>& effects) {
    QuantizationOptions options;
    for (const std::string& effect : effects) options.effect_sets.push_back(with_effect(effect).effects);
    return quantize_to_file(
               *random_float32_model(77), {make_near_shoemaker()}, 10, folder.path("near.tsm"),
               [](std::uint64_t) {}, {}, options)
        .crc32;
  };
  // Each quantization takes seconds.
  const std::uint32_t of_both = crc32_of({"noise=3", "dropout=0.6"});
  EXPECT_EQ(read_fixed_point_header(folder.path("near.tsm")).noise, (gnc::RangeNoise{300, 3000}));
  EXPECT_NE(of_both, crc32_with("noise=3", folder)) << "the second set counts too";
}

// Verifies TS-SIL-300.
TEST(Calibration, NoiseChangesTheImageAndIsNotedInIt) {
  const TemporaryFolder folder;
  const auto noise = [&] { return read_fixed_point_header(folder.path("near.tsm")).noise; };
  const std::uint32_t plain = crc32_with("noise=1", folder);
  EXPECT_EQ(noise(), (gnc::RangeNoise{100, 1000})) << "the paper's sensor";
  EXPECT_NE(crc32_with("noise=3", folder), plain);
  EXPECT_EQ(noise(), (gnc::RangeNoise{300, 3000})) << "by which the flight program judges depths";
  EXPECT_NE(crc32_with("noise=1:3", folder), plain);
  EXPECT_EQ(noise(), (gnc::RangeNoise{200, 2000})) << "the middle of the range";
}

// Verifies TS-SIL-300.
TEST(Calibration, EffectsChangeTheImageAndOneThatHidesTheTargetIsRefused) {
  const TemporaryFolder folder;
  const auto crc32_with = [&](const std::string& effect) { return sim::crc32_with(effect, folder); };
  const std::uint32_t plain = crc32_with("noise=1");
  EXPECT_NE(crc32_with("dropout=0.6"), plain);
  EXPECT_NE(crc32_with("panel_turn=30"), plain) << "the body";
  try {
    crc32_with("lobe=1");
    FAIL() << "calibrated without a frame";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("the sensor sees too little"), std::string::npos)
        << error.what();
  }
}

// In an image, no noise at all stands for the paper's.
TEST(Calibration, SensorWithoutNoiseIsNotJudgedByThePapers) {
  const TemporaryFolder folder;
  ScenarioSettings seen;
  seen.sensor.noise_constant_m = seen.sensor.noise_per_range = 0.0;
  (void)quantize_to_file(
      *random_float32_model(77), {make_near_shoemaker()}, 10, folder.path("near.tsm"), [](std::uint64_t) {},
      seen);
  EXPECT_EQ(read_fixed_point_header(folder.path("near.tsm")).noise, (gnc::RangeNoise{1, 0}));
}

TEST_F(QuantizeTest, ReportsProgressAndTheDifferenceOfAQuarterOfTheFrames) {
  EXPECT_EQ(steps, kSequences);
  EXPECT_GT(report->difference.count, 0U);
  EXPECT_LE(report->difference.count, 30U);  // a quarter of the sequences, ten frames each
}

}  // namespace
}  // namespace tumblesight::sim
