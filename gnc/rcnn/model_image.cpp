#include "gnc/rcnn/model_image.hpp"

#include <cstring>

#include "gnc/numerics/crc.hpp"
#include "gnc/rcnn/model_format.hpp"
#include "gnc/rcnn/model_values.hpp"

namespace tumblesight::gnc {
namespace {

using namespace model_format;

// Limit for the section table of another network, which is recognized as such if its header is intact.
constexpr std::uint32_t kMaxSections = 256;

constexpr std::uint32_t fnv1a(std::uint32_t hash, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) hash = (hash ^ ((value >> (8 * i)) & 0xFFU)) * 16777619U;
  return hash;
}

constexpr std::uint32_t compute_architecture_hash() {
  std::uint32_t hash = 2166136261U;
  for (const int size : shape::kHashed) hash = fnv1a(hash, static_cast<std::uint32_t>(size));
  return hash;
}

constexpr std::uint32_t kArchitectureHash = compute_architecture_hash();

// At least one printable character, and only NULs from the first NUL to the end of the field.
bool is_well_formed_target(const char* field, std::size_t size) {
  std::size_t length = 0;
  while (length < size && field[length] >= ' ' && field[length] <= '~') ++length;
  bool padded = length > 0 && length < size;
  for (std::size_t i = length; i < size; ++i) padded = padded && field[i] == '\0';
  return padded;
}

ModelStatus check_header_integrity(const std::uint8_t* image, std::size_t size_bytes) {
  if (image == nullptr || size_bytes < kModelHeaderSize) return ModelStatus::kTooShort;
  if (std::memcmp(image, kMagic.data(), kMagic.size()) != 0) return ModelStatus::kBadMagic;
  const std::uint16_t version = get_u16(image + kOffsetVersion);
  if (version != kModelFormatVersion<FixedPoint> && version != kModelFormatVersion<Float32>)
    return ModelStatus::kBadVersion;
  if (get_u16(image + kOffsetHeaderSize) != kModelHeaderSize) return ModelStatus::kBadSize;
  const std::uint32_t sections = get_u32(image + kOffsetSectionCount);
  if (sections < 1 || sections > kMaxSections) return ModelStatus::kBadSize;
  if (size_bytes < data_offset(sections)) return ModelStatus::kTooShort;
  if (header_crc(image, sections) != get_u32(image + kOffsetHeaderCrc)) return ModelStatus::kBadHeaderCrc;
  if (get_u32(image + kOffsetTotalSize) != size_bytes) return ModelStatus::kBadSize;
  return ModelStatus::kOk;
}

// False if the matrix is not an inertia with a trace of 3 (within rounding).
bool read_inertia(const std::uint8_t* image, Inertia<Fixed>& inertia) {
  Matrix3<Fixed> tensor;
  for (std::size_t i = 0; i < kInertiaElements.size(); ++i) {
    const auto [row, column] = kInertiaElements[i];
    tensor(row, column) = Fixed::from_raw(static_cast<std::int32_t>(get_u32(image + kOffsetInertia + 4 * i)));
    tensor(column, row) = tensor(row, column);
  }
  const Fixed trace = (tensor(0, 0) + tensor(1, 1)) + tensor(2, 2);
  return abs(trace - Fixed(3.0)) < Fixed(1e-3) && make_inertia<Fixed>(tensor, inertia);
}

DepthProjection read_projection(const std::uint8_t* image) {
  return {get_u32(image + kOffsetSwath), get_u32(image + kOffsetRadius)};
}

RangeNoise read_noise(const std::uint8_t* image) {
  if (get_u32(image + kOffsetNoise) == 0) return {};
  return {get_u16(image + kOffsetNoise), get_u16(image + kOffsetNoise + 2)};
}

template <class N>
ModelStatus check_header_values(const std::uint8_t* image, const char* expected_target) {
  if (get_u32(image + kOffsetNumerics) != numerics_of<N>()) return ModelStatus::kBadNumerics;
  if (get_u16(image + kOffsetVersion) != kModelFormatVersion<N>) return ModelStatus::kBadVersion;
  if (get_u32(image + kOffsetArchitecture) != kArchitectureHash) return ModelStatus::kBadArchitecture;
  ModelHeader header;
  std::memcpy(header.target.data(), image + kOffsetTarget, header.target.size());
  if (!is_well_formed_target(header.target.data(), header.target.size())) return ModelStatus::kBadTarget;
  if (expected_target != nullptr && std::strcmp(header.target.data(), expected_target) != 0) {
    return ModelStatus::kBadTarget;
  }
  const bool possible = read_inertia(image, header.inertia) && is_possible(read_projection(image));
  return possible ? ModelStatus::kOk : ModelStatus::kBadValue;
}

void read_header(const std::uint8_t* image, ModelHeader& header) {
  std::memcpy(header.target.data(), image + kOffsetTarget, header.target.size());
  header.projection = read_projection(image);
  header.noise = read_noise(image);
  (void)read_inertia(image, header.inertia);  // valid: check_header_values()
  header.mission_crc32 = get_u32(image + mission_offset(get_u32(image + kOffsetSectionCount)));
  header.crc32 = get_u32(image + kOffsetHeaderCrc);
}

template <std::size_t kCount>
void read(const std::uint8_t* from, FixedPoint::Weights<kCount>& tensor) {
  tensor.set_data(reinterpret_cast<const std::int8_t*>(from));
}
template <std::size_t kCount>
void read(const std::uint8_t* from, std::array<float, kCount>& tensor) {
  for (std::size_t i = 0; i < kCount; ++i) tensor[i] = get_f32(from + 4 * i);
}
template <class Integer, std::size_t kCount>
void read(const std::uint8_t* from, std::array<Integer, kCount>& tensor) {
  for (std::size_t i = 0; i < kCount; ++i) tensor[i] = static_cast<Integer>(get_u32(from + 4 * i));
}

// Checks the section table entry by entry. `status` is that of the first bad entry.
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
    return crc32(image + offset, size) == get_u32(entry + 12) ? ModelStatus::kOk
                                                              : ModelStatus::kBadSectionCrc;
  }
};

// Whether a section of SurfaceMesh::kMaxBytes is a sound mesh and then zeros.
bool is_possible_mesh(const std::uint8_t* section) {
  if (!SurfaceMesh::is_sound(section, SurfaceMesh::kMaxBytes)) return false;
  const SurfaceMesh mesh(section);
  const auto count = [](int number) { return static_cast<std::size_t>(number); };
  std::uint8_t behind = 0;
  for (std::size_t at = SurfaceMesh::kHeaderBytes + 6 * count(mesh.vertices()) + 6 * count(mesh.triangles()) +
                        8 * count(mesh.edges());
       at < SurfaceMesh::kMaxBytes; ++at) {
    behind = static_cast<std::uint8_t>(behind | section[at]);
  }
  return behind == 0;
}

template <class N>
bool has_possible_surface(const std::uint8_t* image) {
  if (!N::kIsInteger) return true;
  return surface_of<N>(image).points() <= SurfaceModel::kMaxPoints &&
         is_possible_mesh(image + (kModelImageSize<N> - kMeshBytes<N>));
}

// Uses only the number and sizes of the tensors in `weights`.
template <class N>
ModelStatus check_sections(const std::uint8_t* image, std::size_t size_bytes,
                           const NetworkWeights<N>& weights) {
  if (get_u32(image + kOffsetSectionCount) != kModelSections<N> || size_bytes != kModelImageSize<N>) {
    return ModelStatus::kBadSection;
  }
  SectionCheck check{image, kModelDataOffset<N>};
  for_each_tensor(
      weights, [&check](const char*, const char*, const auto& tensor) { check.next(size_in_image(tensor)); });
  if (N::kIsInteger) {
    check.next(kSurfaceBytes<N>);
    check.next(kMeshBytes<N>);
  }
  if (check.status != ModelStatus::kOk) return check.status;
  const bool possible = has_possible_surface<N>(image) && has_possible_values(image, weights);
  return possible ? ModelStatus::kOk : ModelStatus::kBadValue;
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
  ModelStatus status = check_header_integrity(image, size_bytes);
  if (status == ModelStatus::kOk) status = check_header_values<N>(image, expected_target);
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
  return check_header_integrity(image, size_bytes) == ModelStatus::kOk &&
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

#define TUMBLESIGHT_INSTANTIATE(N)                                                                      \
  template ModelStatus check_model_image<N>(const std::uint8_t*, std::size_t, const char*,              \
                                            const NetworkWeights<N>&);                                  \
  template void take_model_image<N>(const std::uint8_t*, ModelHeader&, NetworkWeights<N>&);             \
  template ModelStatus read_model_image<N>(const std::uint8_t*, std::size_t, const char*, ModelHeader&, \
                                           NetworkWeights<N>&)

TUMBLESIGHT_INSTANTIATE(FixedPoint);
#if TUMBLESIGHT_FLOAT32
TUMBLESIGHT_INSTANTIATE(Float32);
#endif

}  // namespace tumblesight::gnc
