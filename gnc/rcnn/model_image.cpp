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
constexpr std::size_t kOffsetEncoding = 56;
constexpr std::size_t kOffsetInertia = 60;
constexpr std::size_t kOffsetSectionCount = 84;
constexpr std::size_t kOffsetHeaderCrc = 88;
// Bounds the reading of another network's section table, so that it is told apart from a damaged image.
constexpr std::uint32_t kMaxSections = 256;

static_assert(sizeof(float) == 4 && kModelImageSize < 0xFFFFFFFFU);

std::uint16_t get_u16(const std::uint8_t* at) {
  return static_cast<std::uint16_t>(at[0] | (at[1] << 8));
}

std::uint32_t get_u32(const std::uint8_t* at) {
  return static_cast<std::uint32_t>(at[0]) | (static_cast<std::uint32_t>(at[1]) << 8) |
         (static_cast<std::uint32_t>(at[2]) << 16) | (static_cast<std::uint32_t>(at[3]) << 24);
}

float get_f32(const std::uint8_t* at) {
  const std::uint32_t bits = get_u32(at);
  float value;
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

void put_f32(std::uint8_t* at, float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  put_u32(at, bits);
}

// By the bits, so that no compiler option can make it always true.
bool is_finite_bits(std::uint32_t bits) {
  return (bits & 0x7F800000U) != 0x7F800000U;
}

bool is_positive(const std::uint8_t* at) {
  return is_finite_bits(get_u32(at)) && get_f32(at) > 0.0F;
}

constexpr std::uint32_t fnv1a(std::uint32_t hash, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) hash = (hash ^ ((value >> (8 * i)) & 0xFFU)) * 16777619U;
  return hash;
}

constexpr std::uint32_t compute_architecture_hash() {
  constexpr char kNumerics[] = "float32";
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
  for (const char letter : kNumerics) hash = fnv1a(hash, static_cast<std::uint32_t>(letter));
  return hash;
}

constexpr std::uint32_t kArchitectureHash = compute_architecture_hash();

std::uint32_t header_crc(const std::uint8_t* image, std::size_t sections) {
  Crc32 crc;
  crc.add(image, kOffsetHeaderCrc);
  crc.add(image + kModelHeaderSize, sections * kModelSectionEntrySize);
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
  if (size_bytes < kModelHeaderSize + sections * kModelSectionEntrySize) return ModelStatus::kTooShort;
  if (header_crc(image, sections) != get_u32(image + kOffsetHeaderCrc)) return ModelStatus::kBadHeaderCrc;
  if (get_u32(image + kOffsetTotalSize) != size_bytes) return ModelStatus::kBadSize;
  return ModelStatus::kOk;
}

// xx, yy, zz, xy, xz, yz.
constexpr std::array<std::array<int, 2>, 6> kInertiaElements{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};

bool read_inertia(const std::uint8_t* image, Inertia& inertia) {
  Eigen::Matrix3f tensor;
  for (std::size_t i = 0; i < kInertiaElements.size(); ++i) {
    const auto [row, column] = kInertiaElements[i];
    tensor(row, column) = get_f32(image + kOffsetInertia + 4 * i);
    tensor(column, row) = tensor(row, column);
  }
  return make_inertia(tensor, inertia);
}

ModelStatus check_meaning(const std::uint8_t* image, const char* expected_target) {
  if (get_u32(image + kOffsetArchitecture) != kArchitectureHash) return ModelStatus::kBadArchitecture;
  ModelHeader header;
  std::memcpy(header.target.data(), image + kOffsetTarget, header.target.size());
  if (!is_well_formed_target(header.target.data(), header.target.size())) return ModelStatus::kBadTarget;
  if (expected_target != nullptr && std::strcmp(header.target.data(), expected_target) != 0) {
    return ModelStatus::kBadTarget;
  }
  const bool possible =
      read_inertia(image, header.inertia) && is_positive(image + kOffsetSwath) &&
      is_positive(image + kOffsetRadius) &&
      get_u32(image + kOffsetEncoding) <= static_cast<std::uint32_t>(DepthEncoding::kPaperMaximum);
  return possible ? ModelStatus::kOk : ModelStatus::kBadValue;
}

// `count` floats as section `index` at `offset`.
ModelStatus check_section(const std::uint8_t* image, std::size_t index, std::size_t offset,
                          std::size_t count) {
  const std::uint8_t* entry = image + kModelHeaderSize + index * kModelSectionEntrySize;
  const std::size_t size = count * sizeof(float);
  if (get_u32(entry) != index + 1 || get_u32(entry + 4) != offset || get_u32(entry + 8) != size) {
    return ModelStatus::kBadSection;
  }
  if (crc32(image + offset, size) != get_u32(entry + 12)) return ModelStatus::kBadSectionCrc;
  bool finite = true;
  for (std::size_t i = 0; i < count; ++i) finite = is_finite_bits(get_u32(image + offset + 4 * i)) && finite;
  return finite ? ModelStatus::kOk : ModelStatus::kBadValue;
}

// `weights` only lends the number and sizes of the tensors.
ModelStatus check_sections(const std::uint8_t* image, std::size_t size_bytes, const NetworkWeights& weights) {
  if (get_u32(image + kOffsetSectionCount) != kTensorCount || size_bytes != kModelImageSize) {
    return ModelStatus::kBadSection;
  }
  ModelStatus status = ModelStatus::kOk;
  std::size_t index = 0;
  std::size_t offset = kModelDataOffset;
  for_each_tensor(weights, [&](const char*, const float*, std::size_t count) {
    if (status == ModelStatus::kOk) status = check_section(image, index, offset, count);
    ++index;
    offset += count * sizeof(float);
  });
  return status;
}

ModelStatus check(const std::uint8_t* image, std::size_t size_bytes, const char* expected_target,
                  const NetworkWeights& weights) {
  ModelStatus status = check_frame_of_header(image, size_bytes);
  if (status == ModelStatus::kOk) status = check_meaning(image, expected_target);
  if (status == ModelStatus::kOk) status = check_sections(image, size_bytes, weights);
  return status;
}

void read_header(const std::uint8_t* image, ModelHeader& header) {
  std::memcpy(header.target.data(), image + kOffsetTarget, header.target.size());
  header.projection.swath_m = get_f32(image + kOffsetSwath);
  header.projection.target_radius_m = get_f32(image + kOffsetRadius);
  header.projection.encoding = static_cast<DepthEncoding>(get_u32(image + kOffsetEncoding));
  (void)read_inertia(image, header.inertia);  // check_meaning() has seen that it is one
  header.crc32 = get_u32(image + kOffsetHeaderCrc);
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

ModelStatus read_model_image(const std::uint8_t* image, std::size_t size_bytes, const char* expected_target,
                             ModelHeader& header, NetworkWeights& weights) {
  const ModelStatus status = check(image, size_bytes, expected_target, weights);
  if (status != ModelStatus::kOk) return status;
  read_header(image, header);
  const std::uint8_t* next = image + kModelDataOffset;
  for_each_tensor(weights, [&next](const char*, float* data, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) data[i] = get_f32(next + 4 * i);
    next += count * sizeof(float);
  });
  return status;
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

std::size_t write_model_image(const ModelHeader& header, const NetworkWeights& weights, std::uint8_t* out,
                              std::size_t capacity) {
  if (capacity < kModelImageSize) return 0;
  std::memcpy(out, kMagic.data(), kMagic.size());
  put_u16(out + kOffsetVersion, kModelFormatVersion);
  put_u16(out + kOffsetHeaderSize, static_cast<std::uint16_t>(kModelHeaderSize));
  put_u32(out + kOffsetTotalSize, static_cast<std::uint32_t>(kModelImageSize));
  put_u32(out + kOffsetArchitecture, kArchitectureHash);
  std::memcpy(out + kOffsetTarget, header.target.data(), header.target.size());
  put_f32(out + kOffsetSwath, header.projection.swath_m);
  put_f32(out + kOffsetRadius, header.projection.target_radius_m);
  put_u32(out + kOffsetEncoding, static_cast<std::uint32_t>(header.projection.encoding));
  for (std::size_t i = 0; i < kInertiaElements.size(); ++i) {
    const auto [row, column] = kInertiaElements[i];
    put_f32(out + kOffsetInertia + 4 * i, header.inertia.tensor_trf(row, column));
  }
  put_u32(out + kOffsetSectionCount, static_cast<std::uint32_t>(kTensorCount));

  std::uint8_t* entry = out + kModelHeaderSize;
  std::uint32_t id = 1;
  std::size_t offset = kModelDataOffset;
  for_each_tensor(weights, [&](const char*, const float* data, std::size_t count) {
    const std::size_t size = count * sizeof(float);
    for (std::size_t i = 0; i < count; ++i) put_f32(out + offset + 4 * i, data[i]);
    put_u32(entry, id++);
    put_u32(entry + 4, static_cast<std::uint32_t>(offset));
    put_u32(entry + 8, static_cast<std::uint32_t>(size));
    put_u32(entry + 12, crc32(out + offset, size));
    entry += kModelSectionEntrySize;
    offset += size;
  });
  put_u32(out + kOffsetHeaderCrc, header_crc(out, kTensorCount));
  return kModelImageSize;
}

}  // namespace tumblesight::gnc
