#include "gnc/rcnn/model_values.hpp"

#include "gnc/rcnn/model_format.hpp"

namespace tumblesight::gnc {
namespace {

using model_format::get_u32;
using model_format::size_in_image;

// What a layer's integers may be, given the largest magnitude of its inputs.
struct LayerLimits {
  int group;
  std::int64_t largest_input;
  std::uint32_t largest_shift;
  std::int64_t largest_sum = INT32_MAX;  // rounding included
};

// Where the tensors of a layer lie.
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

// Sum of the magnitudes of one channel's weights; -1 where one is -128, which has no opposite.
std::int64_t abs(const std::uint8_t* weights, std::size_t count, std::size_t channels, std::size_t channel,
                 std::size_t group) {
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

// No sum of the layer can leave 32 bits, rounding included, and every shift is in its range.
bool is_possible_layer(const LayerInImage& layer, std::size_t channels, const LayerLimits& limits) {
  const auto group = static_cast<std::size_t>(limits.group);
  bool possible = true;
  for (std::size_t c = 0; c < channels; ++c) {
    const std::int64_t forward = abs(layer.weight, layer.weights, channels, c, group);
    const std::int64_t recurrent =
        layer.recurrents > 0 ? abs(layer.recurrent, layer.recurrents, channels, c, group) : 0;
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

constexpr std::uint32_t kLargestActivationShift = 30;
constexpr std::uint32_t kLargestOutputShift = 62;

}  // namespace

bool has_possible_values(const std::uint8_t* image, const NetworkWeights<FixedPoint>& weights) {
  const LayerLimits conv{Int8Product::kGroup, 255, kLargestActivationShift, kMaxConvSum};
  const LayerLimits hidden{Int16Product::kGroup, 32767, kLargestActivationShift};
  const LayerLimits output{Int16Product::kGroup, 32767, kLargestOutputShift};
  const LayerLimits pooled{Int16Product::kGroup, 4 * kMaxAveragedActivation, kLargestActivationShift};
  // In the order of for_each_layer().
  const std::array<LayerLimits, 10> limits{conv,   conv,   conv,   conv,   pooled,
                                           hidden, output, output, hidden, output};
  const std::uint8_t* next = image + kModelDataOffset<FixedPoint>;
  std::size_t index = 0;
  bool possible = true;
  for_each_layer(weights, [&](const char* name, const auto& layer) {
    LayerInImage in_image;
    for_each_tensor_of(name, layer, [&](const char*, const char* part, const auto& tensor) {
      in_image.put(part, next, size_in_image(tensor));
      next += size_in_image(tensor);
    });
    possible = is_possible_layer(in_image, layer.bias.size(), limits[index++]) && possible;
  });
  return possible;
}

#if TUMBLESIGHT_FLOAT32
namespace {

// By the bits, so that no compiler option can make it always true.
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
