#include "gnc/rcnn/model_values.hpp"

#include <limits>

#include "gnc/rcnn/model_format.hpp"

namespace tumblesight::gnc {
namespace {

using model_format::get_u32;
using model_format::size_in_image;

// Limits of one layer's integers.
struct LayerLimits {
  int group;                   // inputs whose weights are adjacent
  std::int64_t largest_input;  // magnitude
  std::uint32_t largest_shift;
  std::int64_t largest_sum;  // magnitude, rounding included
};

constexpr std::uint32_t kLargestActivationShift = 30;
constexpr std::uint32_t kLargestRealShift = 62;  // of sums that become real numbers: outputs and LSTM gates

template <int kIndex>
constexpr LayerLimits limits_of() {
  using LayerType = Layer<FixedPoint, kIndex>;
  const LayerRow& row = kLayers[kIndex];
  const int before = layer_index(row.reads[0]);
  const bool reads_average = before < kLayerCount && kLayers[before].output == LayerOutput::kAveragePooled;
  const bool real = sums_of(row.kind).become_real || row.output == LayerOutput::kOutput;
  return {LayerType::Product::kGroup,
          reads_average ? 4 * kMaxAveragedActivation
                        : std::numeric_limits<typename LayerType::Product::Input>::max(),
          real ? kLargestRealShift : kLargestActivationShift, LayerType::kLargestSum};
}

// The tensors of one layer in the image.
struct LayerInImage {
  const std::uint8_t* weight = nullptr;
  std::size_t weights = 0;
  const std::uint8_t* recurrent = nullptr;
  std::size_t recurrents = 0;
  const std::uint8_t* bias = nullptr;
  const std::uint8_t* shift = nullptr;

  // `part`: as for_each_tensor_of() names it.
  void put(const char* part, const std::uint8_t* at, std::size_t size) {
    switch (part[0]) {
      case 'w':
        weight = at;
        weights = size;
        break;
      case 'r':
        recurrent = at;
        recurrents = size;
        break;
      case 'b':
        bias = at;
        break;
      default:
        shift = at;
    }
  }
};

// Sum of the magnitudes of one channel's weights; -1 if one of them is -128, which int8 cannot negate.
std::int64_t sum_of_magnitudes(const std::uint8_t* weights, std::size_t count, std::size_t channels,
                               std::size_t channel, std::size_t group) {
  std::int64_t sum = 0;
  bool symmetric = true;
  for (std::size_t first = channel * group; first < count; first += channels * group) {
    for (std::size_t i = first; i < first + group; ++i) {
      const int weight = static_cast<std::int8_t>(weights[i]);
      symmetric = symmetric && weight != -128;
      sum += weight < 0 ? -weight : weight;
    }
  }
  return symmetric ? sum : -1;
}

// Whether no sum of the layer can exceed its limit, rounding included, and every shift is in range.
bool is_valid_layer(const LayerInImage& layer, std::size_t channels, const LayerLimits& limits) {
  const auto group = static_cast<std::size_t>(limits.group);
  bool possible = true;
  for (std::size_t c = 0; c < channels; ++c) {
    const std::int64_t forward = sum_of_magnitudes(layer.weight, layer.weights, channels, c, group);
    const std::int64_t recurrent =
        layer.recurrents > 0 ? sum_of_magnitudes(layer.recurrent, layer.recurrents, channels, c, group) : 0;
    const std::int64_t bias = static_cast<std::int32_t>(get_u32(layer.bias + 4 * c));
    const std::uint32_t shift = get_u32(layer.shift + 4 * c);
    const bool in_range = shift >= 1 && shift <= limits.largest_shift && forward >= 0 && recurrent >= 0;
    const std::int64_t rounding = std::int64_t{1} << (in_range && shift <= 31 ? shift - 1 : 0);
    const std::int64_t largest =
        (bias < 0 ? -bias : bias) + (forward + recurrent) * limits.largest_input + rounding;
    possible = possible && in_range && largest <= limits.largest_sum;
  }
  return possible;
}

}  // namespace

bool has_possible_values(const std::uint8_t* image, const NetworkWeights<FixedPoint>& weights) {
  const std::uint8_t* next = image + kModelDataOffset<FixedPoint>;
  bool possible = true;
  for_each_index<0, kLayerCount>([&](auto index) {
    constexpr LayerLimits kLimits = limits_of<decltype(index)::value>();
    const auto& layer = layer_weights<decltype(index)::value>(weights);
    LayerInImage in_image;
    for_each_tensor_of(layer, [&](const char* part, const auto& tensor) {
      in_image.put(part, next, size_in_image(tensor));
      next += size_in_image(tensor);
    });
    possible = is_valid_layer(in_image, layer.bias.size(), kLimits) && possible;
  });
  return possible;
}

#if TUMBLESIGHT_FLOAT32
namespace {

// On the bits: with fast-math a compiler may assume that std::isfinite() is always true.
bool is_finite_bits(std::uint32_t bits) {
  return (bits & 0x7F800000U) != 0x7F800000U;
}

}  // namespace

bool has_possible_values(const std::uint8_t* image, const NetworkWeights<Float32>&) {
  bool finite = true;
  for (std::size_t at = kModelDataOffset<Float32>; at < kModelImageSize<Float32>; at += 4) {
    finite = is_finite_bits(get_u32(image + at)) && finite;
  }
  return finite;
}
#endif

}  // namespace tumblesight::gnc
