#include "tests/support/test_models.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <type_traits>

#include "gnc/numerics/conversion.hpp"
#include "gnc/rcnn/model_format.hpp"

namespace tumblesight::gnc {

void fill_random(NetworkWeights<Float32>& weights, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  for_each_layer(weights, [&](const LayerRow& row, auto& layer) {
    // Products per sum: all inputs of a channel in the CNN; for the LSTM and the recurrent head only the
    // hidden units are counted.
    std::size_t fan_in = layer.weight.size() / layer.bias.size();
    if (sums_of(row.kind).read_state) fan_in = shape::kLstm;
    if (layer_index(row.name) > kLstmLayer) fan_in = shape::kHead;
    for_each_tensor_of(layer, [&](const char* part, auto& tensor) {
      const float bound =
          std::strcmp(part, "bias") == 0 ? 0.1F : std::sqrt(6.0F / static_cast<float>(fan_in));
      for (float& value : tensor) value = bound * uniform(engine);
    });
  });
}

// Random integers. The shifts are chosen so that the outputs use each layer's range.
class RandomIntegers {
 public:
  explicit RandomIntegers(unsigned seed) : engine_(seed) {
    constexpr std::array<std::uint8_t, 10> kShifts{8, 9, 9, 7, 8, 8, 20, 22, 10, 21};
    static_assert(kShifts.size() == kLayerCount, "one shift for each layer of kLayers, at its place");
    std::size_t index = 0;
    for_each_layer(weights, [&](const LayerRow&, auto& layer) {
      put(layer.weight);
      if constexpr (HasRecurrent<std::remove_reference_t<decltype(layer)>>::value) put(layer.recurrent);
      for (std::int32_t& bias : layer.bias) bias = 40 * next();
      layer.shift.fill(kShifts[index++]);
    });
  }
  NetworkWeights<FixedPoint> weights;

 private:
  int next() { return std::uniform_int_distribution<int>(-60, 60)(engine_); }
  template <class Weights>
  void put(Weights& tensor) {
    auto& bytes = storage_.emplace_back(tensor.size());
    for (std::int8_t& byte : bytes) byte = static_cast<std::int8_t>(next());
    tensor.set_data(bytes.data());
  }
  std::mt19937 engine_;
  std::vector<std::vector<std::int8_t>> storage_;
};

template <class N>
std::vector<std::uint8_t> image_of(const NetworkWeights<N>& weights, const ModelHeader& header) {
  std::vector<std::uint8_t> image(kModelImageSize<N>);
  if (write_model_image<N>(header, weights, image.data(), image.size()) != image.size()) std::abort();
  return image;
}

ModelHeader test_header() {
  ModelHeader header;
  if (!set_target(header, "test_craft")) std::abort();
  header.projection.swath_mm = 7500;
  header.projection.target_radius_mm = 3250;
  Eigen::Matrix3f tensor_trf;
  tensor_trf << 3.0F, 0.4F, -0.2F, 0.4F, 5.0F, 0.1F, -0.2F, 0.1F, 6.0F;
  tensor_trf *= 3.0F / 14.0F;
  if (!make_inertia<Fixed>(converted<Fixed>(tensor_trf), header.inertia)) std::abort();
  return header;
}

template <>
std::vector<std::uint8_t> random_model_image<Float32>(unsigned seed, const ModelHeader& header) {
  auto weights = std::make_unique<NetworkWeights<Float32>>();
  fill_random(*weights, seed);
  return image_of<Float32>(*weights, header);
}
template <>
std::vector<std::uint8_t> random_model_image<FixedPoint>(unsigned seed, const ModelHeader& header) {
  return image_of<FixedPoint>(RandomIntegers(seed).weights, header);
}

template <class N>
const std::vector<std::uint8_t>& lasting_model_image(unsigned seed) {
  static std::map<unsigned, std::vector<std::uint8_t>> images;
  const auto found = images.find(seed);
  return found != images.end() ? found->second
                               : images.emplace(seed, random_model_image<N>(seed)).first->second;
}
template const std::vector<std::uint8_t>& lasting_model_image<Float32>(unsigned);
template const std::vector<std::uint8_t>& lasting_model_image<FixedPoint>(unsigned);

std::vector<std::uint8_t> with_changed_weights(std::vector<std::uint8_t> image,
                                               std::initializer_list<std::size_t> offsets) {
  using namespace model_format;
  for (const std::size_t offset : offsets) image[offset] ^= 1;
  const std::uint32_t sections = get_u32(image.data() + kOffsetSectionCount);
  for (std::size_t i = 0; i < sections; ++i) {
    std::uint8_t* const entry = image.data() + kModelHeaderSize + i * kModelSectionEntrySize;
    put_u32(entry + 12, crc32(image.data() + get_u32(entry + 4), get_u32(entry + 8)));
  }
  put_u32(image.data() + kOffsetHeaderCrc, header_crc(image.data(), sections));
  return image;
}

DepthImage random_depth_image(unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_int_distribution<int> uniform(DepthImage::kSmallest, DepthImage::kLargest);
  DepthImage image;
  for (int row = 20; row < 80; ++row) {
    for (int column = 10; column < 90; ++column) {
      const int depth = uniform(engine);
      image.depth[row * DepthImage::kSide + column] = static_cast<std::uint16_t>(depth > 20'000 ? depth : 0);
    }
  }
  return image;
}

LstmInput<Float32> random_lstm_input(unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  LstmInput<Float32> input;
  for (float& value : input) value = uniform(engine);
  return input;
}

RangeImage random_frame(unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_int_distribution<int> counts(50 * 128 - 200, 50 * 128 + 200);  // 50 m, Q9.7
  RangeImage frame;
  frame.rays = 64;
  frame.fov_urad = 150'000;  // 7.5 m at 50 m
  for (int row = 16; row < 48; ++row) {
    for (int column = 12; column < 52; ++column) {
      frame.ranges[row * 64 + column] = static_cast<std::uint16_t>(counts(engine));
    }
  }
  return frame;
}

}  // namespace tumblesight::gnc
