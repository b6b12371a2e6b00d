// Quantization of a network with random weights on rendered sequences, and of the shipped NEAR model.
#include <gtest/gtest.h>

#include <fstream>

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

TEST_F(QuantizeTest, ReportsProgressAndTheDifferenceOfAQuarterOfTheFrames) {
  EXPECT_EQ(steps, kSequences);
  EXPECT_GT(report->difference.count, 0U);
  EXPECT_LE(report->difference.count, 30U);  // a quarter of the sequences, ten frames each
}

}  // namespace
}  // namespace tumblesight::sim
