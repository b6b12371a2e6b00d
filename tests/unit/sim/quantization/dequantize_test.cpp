// A network that is quantized and dequantized computes the same function, and the shipped NEAR model in
// float32 made from its fixed-point image.
#include "sim/quantization/dequantize.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "sim/evaluation/metrics.hpp"
#include "sim/model/network_layers.hpp"
#include "sim/quantization/quantize_file.hpp"
#include "sim/world/math/angles.hpp"
#include "sim/world/target/shipped_meshes.hpp"
#include "tests/support/sim_models.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tumblesight::sim {
namespace {

using gnc::FixedPoint;
using gnc::Float32;

const std::string kNear = TUMBLESIGHT_SOURCE_DIR "/fsw/models/near_shoemaker.tsm";
const std::string kNearFloat32 = TUMBLESIGHT_SOURCE_DIR "/fsw/models/near_shoemaker.float32.tsm";

std::vector<ImageSequence> sequences(int first, int count) {
  const TriangleMesh mesh = make_near_shoemaker();
  const FlashLidar lidar(observed_bodies({}, mesh.name, mesh));
  std::vector<ImageSequence> rendered;
  for (int i = first; i < first + count; ++i)
    rendered.push_back(calibration_sequence({&lidar}, projection_of(mesh), static_cast<std::uint64_t>(i)));
  return rendered;
}

// A network in fixed point with the scales of its activations.
std::unique_ptr<QuantizedNetwork> quantized(const Float32Model& model) {
  Calibration calibration(model.weights,
                          gnc::motion_models<float>(gnc::converted<float>(model.header.inertia)));
  for (const ImageSequence& sequence : sequences(0, 6)) calibration.add(sequence);
  return quantize(model.weights, calibration.statistics());
}

bool is_power_of_two(double value) {
  int exponent = 0;
  return std::frexp(value, &exponent) == 0.5;
}

double norm_of(const TensorView& weight, std::size_t channels, std::size_t channel) {
  double squares = 0.0;
  for (std::size_t i = channel; i < weight.size; i += channels)
    squares += static_cast<double>(weight[i]) * weight[i];
  return std::sqrt(squares);
}

// Root mean square difference of a layer's weights from those before, relative to them, in units of the sums.
double relative_difference(const Float32Layer& before, const std::vector<double>& scales_before,
                           const Float32Layer& after, const std::vector<double>& scales_after) {
  const auto channels = static_cast<std::size_t>(before.row.outputs);
  double error = 0.0, signal = 0.0;
  for (std::size_t i = 0; i < before.weight.size; ++i) {
    const double expected = before.weight[i] * scales_before[i / channels];
    error += std::pow(after.weight[i] * scales_after[i / channels] - expected, 2);
    signal += expected * expected;
  }
  return std::sqrt(error / signal);
}

// Every layer has other widths, groups and paddings.
TEST(Dequantize, KeepsTheFunctionOfTheNetwork) {
  const auto model = random_float32_model(77);
  const auto network = quantized(*model);
  const Scales before = network->scales;
  const auto back = dequantize(network->weights);

  network->scales = back->scales;
  for (const LayerReport& layer : compare(back->weights, *network, model->header.inertia, sequences(20, 4))) {
    EXPECT_GT(layer.snr_db, 28.0) << layer.layer;
    EXPECT_LT(layer.saturated, 0.005) << layer.layer;
  }
  // The scales of the last layers are not free, so that their weights come back, but for their rounding.
  for (const char* name : {"cnn_out", "head2"}) {
    const auto index = static_cast<std::size_t>(gnc::layer_index(name));
    const std::string reads = gnc::kLayers[index].reads[0];
    EXPECT_LT(relative_difference(layers_of(model->weights)[index], before.at(reads),
                                  layers_of(back->weights)[index], back->scales.at(reads)),
              0.04)
        << name;
  }
}

TEST(Dequantize, GivesHiddenChannelsScalesOfANaturalSizeThatArePowersOfTwo) {
  const auto model = dequantized_model(kNear);
  const std::vector<Float32Layer> layers = layers_of(model->weights);
  const std::vector<std::pair<const char*, double>> norms{
      {"conv1", 5.0}, {"conv4", 1.6}, {"dense1", 9.0}, {"dense2", 2.0}, {"head1", 6.0}};
  for (const auto& [name, typical] : norms) {
    const Float32Layer& layer = layers[static_cast<std::size_t>(gnc::layer_index(name))];
    const auto channels = static_cast<std::size_t>(layer.row.outputs);
    for (std::size_t c = 0; c < channels; ++c) {
      const double relative = norm_of(layer.weight, channels, c) / typical;
      EXPECT_GT(relative, 0.707) << name << ", channel " << c;
      EXPECT_LT(relative, 1.415) << name << ", channel " << c;
    }
  }
  const std::vector<std::uint8_t> image = read_model_bytes(kNear);
  gnc::ModelHeader header;
  gnc::NetworkWeights<FixedPoint> weights;
  ASSERT_EQ(gnc::read_model_image<FixedPoint>(image.data(), image.size(), nullptr, header, weights),
            gnc::ModelStatus::kOk);
  const auto network = dequantize(weights);
  for (const auto& [name, scales] : network->scales) {
    for (const double scale : scales) ASSERT_TRUE(is_power_of_two(scale)) << name;
  }
}

// Angles between the attitudes in fixed point and those of a float32 model, per frame.
ErrorSummary difference_from_fixed_point(const Float32Model& model,
                                         const std::vector<ImageSequence>& sequences) {
  const std::vector<std::uint8_t> image = read_model_bytes(kNear);
  gnc::ModelHeader header;
  gnc::NetworkWeights<FixedPoint> weights;
  EXPECT_EQ(gnc::read_model_image<FixedPoint>(image.data(), image.size(), nullptr, header, weights),
            gnc::ModelStatus::kOk);
  const auto float_models = gnc::motion_models<float>(gnc::converted<float>(header.inertia));
  const auto fixed_models = gnc::motion_models<gnc::Fixed>(header.inertia);
  const auto quaternion = [](const gnc::Matrix3<float>& rotation) {
    return Eigen::Quaterniond(rotation.cast<double>()).normalized();
  };
  std::vector<double> differences;
  for (const ImageSequence& sequence : sequences) {
    const auto expected = attitudes_of<FixedPoint>(weights, fixed_models, sequence);
    const auto found = attitudes_of<Float32>(model.weights, float_models, sequence);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      differences.push_back(kDegPerRad * angular_error_rad(quaternion(gnc::converted<float>(expected[i])),
                                                           quaternion(found[i])));
    }
  }
  return summarise(differences);
}

TEST(DequantizeShipped, NearDiffersLessFromFixedPointThanTheNetworkThatWasQuantized) {
  const std::vector<ImageSequence> frames = sequences(300, 40);
  const ErrorSummary trained = difference_from_fixed_point(*read_float32_model(kNearFloat32), frames);
  const ErrorSummary back = difference_from_fixed_point(*dequantized_model(kNear), frames);
  EXPECT_LT(back.median_deg, 0.2);
  EXPECT_LT(back.median_deg, 0.75 * trained.median_deg);
  EXPECT_GT(back.within_5deg, 0.97) << "but for frames in which another hypothesis is chosen";
}

TEST(DequantizeShipped, NearHasTheHeaderOfItsFloat32Image) {
  const TemporaryFolder folder;
  const auto back = dequantized_model(kNear);
  const std::string path = folder.path("near.float32.tsm");
  (void)write_model_file<Float32>(path, back->header, back->weights);
  const std::vector<std::uint8_t> written = read_model_bytes(path), shipped = read_model_bytes(kNearFloat32);
  ASSERT_EQ(written.size(), shipped.size());
  constexpr std::size_t kHeaderCrc = 92;
  EXPECT_TRUE(std::equal(written.begin(), written.begin() + kHeaderCrc, shipped.begin()));
}

TEST(Dequantize, NotesNoNoiseOfASensorJustAsTraining) {
  const TemporaryFolder folder;
  gnc::ModelHeader header = gnc::test_header();
  header.noise = {300, 3000};
  header.mission_crc32 = 0x1234;
  folder.put("a.tsm", gnc::random_model_image<FixedPoint>(5, header));
  const auto model = dequantized_model(folder.path("a.tsm"));
  EXPECT_EQ(model->header.noise, gnc::RangeNoise{});
  EXPECT_EQ(model->header.mission_crc32, 0x1234U);
}

std::string error_of(const std::string& path) {
  try {
    (void)dequantized_model(path);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

TEST(Dequantize, NamesTheFileAndWhatIsWrongWithIt) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_of(kNearFloat32),
            "model image '" + kNearFloat32 + "' is in float32 already; give one in fixed point");
  folder.put("short.tsm", std::vector<std::uint8_t>(10));
  EXPECT_EQ(
      error_of(folder.path("short.tsm")).find("model image '" + folder.path("short.tsm") + "' is refused: "),
      0U);
  EXPECT_NE(error_of(folder.path("none.tsm")).find("does not exist"), std::string::npos);
}

}  // namespace
}  // namespace tumblesight::sim
