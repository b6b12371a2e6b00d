#include "gnc/rcnn/model_image.hpp"

#include <cstring>

#include "gnc/rcnn/crc32.hpp"

namespace tumblesight::gnc {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic{'T', 'S', 'R', 'M'};
constexpr std::size_t kOffsetVersion = 4;
constexpr std::size_t kOffsetHeaderSize = 6;
constexpr std::size_t kOffsetTotalSize = 8;
constexpr std::size_t kOffsetArchitecture = 12;
constexpr std::size_t kOffsetTarget = 16;
constexpr std::size_t kOffsetSwath = 48;
constexpr std::size_t kOffsetRadius = 52;
constexpr std::size_t kOffsetReserved = 56;
constexpr std::size_t kOffsetInertia = 60;
constexpr std::size_t kOffsetNumerics = 84;
constexpr std::size_t kOffsetSectionCount = 88;
constexpr std::size_t kOffsetHeaderCrc = 92;
// Bounds the reading of another network's section table, so that it is told apart from a damaged image.
constexpr std::uint32_t kMaxSections = 256;

static_assert(sizeof(float) == 4);

std::uint16_t get_u16(const std::uint8_t* at) {
  return static_cast<std::uint16_t>(at[0] | (at[1] << 8));
}

std::uint32_t get_u32(const std::uint8_t* at) {
  return static_cast<std::uint32_t>(at[0]) | (static_cast<std::uint32_t>(at[1]) << 8) |
         (static_cast<std::uint32_t>(at[2]) << 16) | (static_cast<std::uint32_t>(at[3]) << 24);
}

float get_f32(const std::uint8_t* at) {
  const std::uint32_t bits = get_u32(at);
  float value = 0.0F;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

void put_u16(std::uint8_t* at, std::uint16_t value) {
  at[0] = static_cast<std::uint8_t>(value);
  at[1] = static_cast<std::uint8_t>(value >> 8);
}

void put_u32(std::uint8_t* at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) at[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

[[maybe_unused]] void put_f32(std::uint8_t* at, float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  put_u32(at, bits);
}

// By the bits, so that no compiler option can make it always true.
bool is_finite_bits(std::uint32_t bits) {
  return (bits & 0x7F800000U) != 0x7F800000U;
}

constexpr std::uint32_t fnv1a(std::uint32_t hash, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) hash = (hash ^ ((value >> (8 * i)) & 0xFFU)) * 16777619U;
  return hash;
}

constexpr std::uint32_t compute_architecture_hash() {
  constexpr int kSizes[] = {shape::kImageSide, shape::kSpaceToDepthChannels,
                            shape::kConv1,     shape::kConv2,
                            shape::kConv3,     shape::kConv4,
                            shape::kFlat,      shape::kDense1,
                            shape::kDense2,    shape::kHypotheses,
                            shape::kOutput,    shape::kLstmInput,
                            shape::kLstm,      shape::kHead,
                            shape::kHeadOutput};
  std::uint32_t hash = 2166136261U;
  for (const int size : kSizes) hash = fnv1a(hash, static_cast<std::uint32_t>(size));
  return hash;
}

constexpr std::uint32_t kArchitectureHash = compute_architecture_hash();

constexpr std::size_t data_offset(std::size_t sections) {
  return (kModelHeaderSize + sections * kModelSectionEntrySize + 63) / 64 * 64;
}

std::uint32_t header_crc(const std::uint8_t* image, std::size_t sections) {
  Crc32 crc;
  crc.add(image, kOffsetHeaderCrc);
  crc.add(image + kModelHeaderSize, data_offset(sections) - kModelHeaderSize);
  return crc.value();
}

// At least one printable character, and NULs from the first to the end of the field.
bool is_well_formed_target(const char* field, std::size_t size) {
  std::size_t length = 0;
  while (length < size && field[length] >= ' ' && field[length] <= '~') ++length;
  bool padded = length > 0 && length < size;
  for (std::size_t i = length; i < size; ++i) padded = padded && field[i] == '\0';
  return padded;
}

ModelStatus check_frame_of_header(const std::uint8_t* image, std::size_t size_bytes) {
  if (image == nullptr || size_bytes < kModelHeaderSize) return ModelStatus::kTooShort;
  if (std::memcmp(image, kMagic.data(), kMagic.size()) != 0) return ModelStatus::kBadMagic;
  if (get_u16(image + kOffsetVersion) != kModelFormatVersion) return ModelStatus::kBadVersion;
  if (get_u16(image + kOffsetHeaderSize) != kModelHeaderSize) return ModelStatus::kBadSize;
  const std::uint32_t sections = get_u32(image + kOffsetSectionCount);
  if (sections < 1 || sections > kMaxSections) return ModelStatus::kBadSize;
  if (size_bytes < data_offset(sections)) return ModelStatus::kTooShort;
  if (header_crc(image, sections) != get_u32(image + kOffsetHeaderCrc)) return ModelStatus::kBadHeaderCrc;
  if (get_u32(image + kOffsetTotalSize) != size_bytes) return ModelStatus::kBadSize;
  return ModelStatus::kOk;
}

// xx, yy, zz, xy, xz, yz.
constexpr std::array<std::array<int, 2>, 6> kInertiaElements{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};

// A trace of 3, but for rounding.
bool read_inertia(const std::uint8_t* image, Inertia<Fixed>& inertia) {
  Matrix3<Fixed> tensor;
  for (std::size_t i = 0; i < kInertiaElements.size(); ++i) {
    const auto [row, column] = kInertiaElements[i];
    tensor(row, column) = Fixed::from_raw(static_cast<std::int32_t>(get_u32(image + kOffsetInertia + 4 * i)));
    tensor(column, row) = tensor(row, column);
  }
  const Fixed trace = (tensor(0, 0) + tensor(1, 1)) + tensor(2, 2);
  return absolute(trace - Fixed(3.0)) < Fixed(1e-3) && make_inertia<Fixed>(tensor, inertia);
}

DepthProjection read_projection(const std::uint8_t* image) {
  return {get_u32(image + kOffsetSwath), get_u32(image + kOffsetRadius)};
}

ModelStatus check_meaning(const std::uint8_t* image, std::uint32_t numerics, const char* expected_target) {
  if (get_u32(image + kOffsetNumerics) != numerics) return ModelStatus::kBadNumerics;
  if (get_u32(image + kOffsetArchitecture) != kArchitectureHash) return ModelStatus::kBadArchitecture;
  ModelHeader header;
  std::memcpy(header.target.data(), image + kOffsetTarget, header.target.size());
  if (!is_well_formed_target(header.target.data(), header.target.size())) return ModelStatus::kBadTarget;
  if (expected_target != nullptr && std::strcmp(header.target.data(), expected_target) != 0) {
    return ModelStatus::kBadTarget;
  }
  const bool possible = read_inertia(image, header.inertia) && is_possible(read_projection(image)) &&
                        get_u32(image + kOffsetReserved) == 0;
  return possible ? ModelStatus::kOk : ModelStatus::kBadValue;
}

void read_header(const std::uint8_t* image, ModelHeader& header) {
  std::memcpy(header.target.data(), image + kOffsetTarget, header.target.size());
  header.projection = read_projection(image);
  (void)read_inertia(image, header.inertia);  // check_meaning() has seen that it is one
  header.crc32 = get_u32(image + kOffsetHeaderCrc);
}

// A tensor in the image: weights in fixed point one byte a number and read in place, all else four bytes.
template <std::size_t kCount>
constexpr std::size_t size_in_image(const FixedPoint::Weights<kCount>&) {
  return kCount;
}
template <class Number, std::size_t kCount>
constexpr std::size_t size_in_image(const std::array<Number, kCount>&) {
  return 4 * kCount;
}

template <std::size_t kCount>
void read(const std::uint8_t* from, FixedPoint::Weights<kCount>& tensor) {
  tensor.lie_at(reinterpret_cast<const std::int8_t*>(from));
}
template <std::size_t kCount>
void read(const std::uint8_t* from, std::array<float, kCount>& tensor) {
  for (std::size_t i = 0; i < kCount; ++i) tensor[i] = get_f32(from + 4 * i);
}
template <class Integer, std::size_t kCount>
void read(const std::uint8_t* from, std::array<Integer, kCount>& tensor) {
  for (std::size_t i = 0; i < kCount; ++i) tensor[i] = static_cast<Integer>(get_u32(from + 4 * i));
}

template <std::size_t kCount>
void write(const FixedPoint::Weights<kCount>& tensor, std::uint8_t* to) {
  std::memcpy(to, tensor.data(), kCount);
}
template <std::size_t kCount>
void write(const std::array<float, kCount>& tensor, std::uint8_t* to) {
  for (std::size_t i = 0; i < kCount; ++i) put_f32(to + 4 * i, tensor[i]);
}
template <class Integer, std::size_t kCount>
void write(const std::array<Integer, kCount>& tensor, std::uint8_t* to) {
  for (std::size_t i = 0; i < kCount; ++i) put_u32(to + 4 * i, static_cast<std::uint32_t>(tensor[i]));
}

// The section table, entry by entry: the first that is wrong decides.
struct SectionCheck {
  const std::uint8_t* image;
  std::size_t offset;  // of the next section
  std::uint32_t id = 1;
  ModelStatus status = ModelStatus::kOk;

  void next(std::size_t size) {
    if (status == ModelStatus::kOk) status = status_of_entry(size);
    offset += size;
    ++id;
  }

 private:
  ModelStatus status_of_entry(std::size_t size) const {
    const std::uint8_t* entry = image + kModelHeaderSize + (id - 1) * kModelSectionEntrySize;
    if (get_u32(entry) != id || get_u32(entry + 4) != offset || get_u32(entry + 8) != size) {
      return ModelStatus::kBadSection;
    }
    return crc32(image + offset, size) == get_u32(entry + 12) ? ModelStatus::kOk : ModelStatus::kBadSectionCrc;
  }
};

#if TUMBLESIGHT_FLOAT32
ModelStatus check_layers(const std::uint8_t* image, const NetworkWeights<Float32>&) {
  bool finite = true;
  for (std::size_t at = kModelDataOffset<Float32>; at < kModelImageSize<Float32>; at += 4) {
    finite = is_finite_bits(get_u32(image + at)) && finite;
  }
  return finite ? ModelStatus::kOk : ModelStatus::kBadValue;
}
#endif

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
std::int64_t magnitude_of(const std::uint8_t* weights, std::size_t count, std::size_t channels, std::size_t channel,
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
    const std::int64_t forward = magnitude_of(layer.weight, layer.weights, channels, c, group);
    const std::int64_t recurrent =
        layer.recurrents > 0 ? magnitude_of(layer.recurrent, layer.recurrents, channels, c, group) : 0;
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

// `weights` only lends the sizes of the tensors.
ModelStatus check_layers(const std::uint8_t* image, const NetworkWeights<FixedPoint>& weights) {
  const LayerLimits conv{Int8Product::kGroup, 255, kLargestActivationShift, kLargestConvolved};
  const LayerLimits hidden{Int16Product::kGroup, 32767, kLargestActivationShift};
  const LayerLimits output{Int16Product::kGroup, 32767, kLargestOutputShift};
  const LayerLimits pooled{Int16Product::kGroup, 4 * kLargestOfFour, kLargestActivationShift};
  // In the order of for_each_layer().
  const std::array<LayerLimits, 10> limits{conv, conv, conv, conv, pooled, hidden, output, output, hidden, output};
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
  return possible ? ModelStatus::kOk : ModelStatus::kBadValue;
}

// `weights` only lends the number and sizes of the tensors.
template <class N>
ModelStatus check_sections(const std::uint8_t* image, std::size_t size_bytes, const NetworkWeights<N>& weights) {
  if (get_u32(image + kOffsetSectionCount) != kTensorCount<N> || size_bytes != kModelImageSize<N>) {
    return ModelStatus::kBadSection;
  }
  SectionCheck check{image, kModelDataOffset<N>};
  for_each_tensor(weights,
                  [&check](const char*, const char*, const auto& tensor) { check.next(size_in_image(tensor)); });
  return check.status == ModelStatus::kOk ? check_layers(image, weights) : check.status;
}

template <class N>
constexpr std::uint32_t numerics_of() {
  return N::kIsInteger ? 1 : 0;
}

}  // namespace

const char* to_string(ModelStatus status) {
  switch (status) {
    case ModelStatus::kOk:
      return "ok";
    case ModelStatus::kTooShort:
      return "too short for a model image";
    case ModelStatus::kBadMagic:
      return "not a model image (magic)";
    case ModelStatus::kBadVersion:
      return "model image of another format version";
    case ModelStatus::kBadSize:
      return "model image has the wrong size";
    case ModelStatus::kBadHeaderCrc:
      return "model image header is damaged (CRC)";
    case ModelStatus::kBadNumerics:
      return "model image of the other numerics (float32, fixed point)";
    case ModelStatus::kBadArchitecture:
      return "model image of another network architecture";
    case ModelStatus::kBadTarget:
      return "model image of another target";
    case ModelStatus::kBadSection:
      return "model image section table does not fit the network";
    case ModelStatus::kBadSectionCrc:
      return "model image weights are damaged (CRC)";
    case ModelStatus::kBadValue:
      return "model image holds an impossible value";
  }
  return "unknown model status";
}

std::uint32_t architecture_hash() {
  return kArchitectureHash;
}

template <class N>
ModelStatus check_model_image(const std::uint8_t* image, std::size_t size_bytes, const char* expected_target,
                              const NetworkWeights<N>& weights) {
  ModelStatus status = check_frame_of_header(image, size_bytes);
  if (status == ModelStatus::kOk) status = check_meaning(image, numerics_of<N>(), expected_target);
  if (status == ModelStatus::kOk) status = check_sections<N>(image, size_bytes, weights);
  return status;
}

template <class N>
void take_model_image(const std::uint8_t* image, ModelHeader& header, NetworkWeights<N>& weights) {
  read_header(image, header);
  const std::uint8_t* next = image + kModelDataOffset<N>;
  for_each_tensor(weights, [&next](const char*, const char*, auto& tensor) {
    read(next, tensor);
    next += size_in_image(tensor);
  });
}

template <class N>
ModelStatus read_model_image(const std::uint8_t* image, std::size_t size_bytes, const char* expected_target,
                             ModelHeader& header, NetworkWeights<N>& weights) {
  const ModelStatus status = check_model_image<N>(image, size_bytes, expected_target, weights);
  if (status == ModelStatus::kOk) take_model_image<N>(image, header, weights);
  return status;
}

std::uint32_t model_image_crc32(const std::uint8_t* image) {
  return get_u32(image + kOffsetHeaderCrc);
}

bool is_float32(const std::uint8_t* image, std::size_t size_bytes) {
  return check_frame_of_header(image, size_bytes) == ModelStatus::kOk &&
         get_u32(image + kOffsetNumerics) == numerics_of<Float32>();
}

bool set_target(ModelHeader& header, const char* name) {
  std::array<char, 32> field{};
  const std::size_t length = std::strlen(name);
  if (length >= field.size()) return false;
  std::memcpy(field.data(), name, length);
  if (!is_well_formed_target(field.data(), field.size())) return false;
  header.target = field;
  return true;
}

template <class N>
std::size_t write_model_image(const ModelHeader& header, const NetworkWeights<N>& weights, std::uint8_t* out,
                              std::size_t capacity) {
  const std::size_t total = kModelImageSize<N>;
  if (capacity < total) return 0;
  std::memset(out, 0, kModelDataOffset<N>);
  std::memcpy(out, kMagic.data(), kMagic.size());
  put_u16(out + kOffsetVersion, kModelFormatVersion);
  put_u16(out + kOffsetHeaderSize, static_cast<std::uint16_t>(kModelHeaderSize));
  put_u32(out + kOffsetTotalSize, static_cast<std::uint32_t>(total));
  put_u32(out + kOffsetArchitecture, kArchitectureHash);
  std::memcpy(out + kOffsetTarget, header.target.data(), header.target.size());
  put_u32(out + kOffsetSwath, header.projection.swath_mm);
  put_u32(out + kOffsetRadius, header.projection.target_radius_mm);
  for (std::size_t i = 0; i < kInertiaElements.size(); ++i) {
    const auto [row, column] = kInertiaElements[i];
    put_u32(out + kOffsetInertia + 4 * i, static_cast<std::uint32_t>(header.inertia.tensor_trf(row, column).raw()));
  }
  put_u32(out + kOffsetNumerics, numerics_of<N>());
  put_u32(out + kOffsetSectionCount, static_cast<std::uint32_t>(kTensorCount<N>));

  std::uint8_t* entry = out + kModelHeaderSize;
  std::uint32_t id = 1;
  std::size_t offset = kModelDataOffset<N>;
  for_each_tensor(weights, [&](const char*, const char*, const auto& tensor) {
    const std::size_t size = size_in_image(tensor);
    write(tensor, out + offset);
    put_u32(entry, id++);
    put_u32(entry + 4, static_cast<std::uint32_t>(offset));
    put_u32(entry + 8, static_cast<std::uint32_t>(size));
    put_u32(entry + 12, crc32(out + offset, size));
    entry += kModelSectionEntrySize;
    offset += size;
  });
  put_u32(out + kOffsetHeaderCrc, header_crc(out, kTensorCount<N>));
  return total;
}

#define TUMBLESIGHT_INSTANTIATE(N)                                                                            \
  template ModelStatus check_model_image<N>(const std::uint8_t*, std::size_t, const char*,                    \
                                            const NetworkWeights<N>&);                                        \
  template void take_model_image<N>(const std::uint8_t*, ModelHeader&, NetworkWeights<N>&);                   \
  template ModelStatus read_model_image<N>(const std::uint8_t*, std::size_t, const char*, ModelHeader&,       \
                                           NetworkWeights<N>&);                                               \
  template std::size_t write_model_image<N>(const ModelHeader&, const NetworkWeights<N>&, std::uint8_t*, std::size_t)

TUMBLESIGHT_INSTANTIATE(FixedPoint);
#if TUMBLESIGHT_FLOAT32
TUMBLESIGHT_INSTANTIATE(Float32);
#endif

}  // namespace tumblesight::gnc
