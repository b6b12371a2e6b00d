// The model image: a trained network in one file or memory region, with everything needed to detect a
// damaged image or one for another network or target. docs/icd.md lists the order of the tensors.
//
// All numbers are little-endian. Floats are IEEE 754 binary32 and occur only in float32 images.
//   offset  size  field
//        0     4  magic "TSRM"
//        4     2  format version: 3 in float32, 5 in fixed point
//        6     2  header size (96)
//        8     4  total size of the image in bytes
//       12     4  architecture hash: network_shape.hpp
//       16    32  target name, printable ASCII, padded with NUL, at least one NUL
//       48     4  depth projection: swath [mm]
//       52     4  depth projection: target radius [mm]
//       56     2  standard deviation of a range that does not grow with it [mm]
//       58     2  ... that grows with it, in 1/100,000 of the range; both 0: 0.1 m + 1 %
//       60    24  inertia of the target in the TRF, scaled to a trace of 3, signed Q7.24:
//                 xx, yy, zz, xy, xz, yz
//       84     4  numerics: 0 float32, 1 fixed point
//       88     4  number of sections: 21 in float32, 33 in fixed point
//       92     4  CRC-32 of bytes 0..91, the section table and what follows it up to the first section
//       96  16 n  section table, 4 bytes per field: id (1, 2, ...), offset, size in bytes,
//                 CRC-32 of the section
//        -     -  zeros up to the next multiple of 64, where the first section begins; but the last four
//                 bytes before it identify the mission that the network was trained for (CRC-32), 0: not
//                 known
//        -     -  sections without gaps: the tensors in the order of for_each_tensor().
//                 Fixed-point weights take one byte each, all other numbers four. In fixed point the last
//                 two sections are the target's surface: points of it
//                 (gnc/surface/surface_model.hpp), then its triangles
//                 (gnc/surface/surface_mesh.hpp) and zeros up to SurfaceMesh::kMaxBytes
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "gnc/attitude/motion.hpp"
#include "gnc/lidar/depth_image.hpp"
#include "gnc/lidar/range_noise.hpp"
#include "gnc/rcnn/network.hpp"
#include "gnc/surface/surface_mesh.hpp"
#include "gnc/surface/surface_model.hpp"

namespace tumblesight::gnc {

template <class N>
inline constexpr std::uint16_t kModelFormatVersion = N::kIsInteger ? 5 : 3;
inline constexpr std::size_t kModelHeaderSize = 96;
inline constexpr std::size_t kModelSectionEntrySize = 16;
// Only the image that flies has a surface. In float32 attitudes are compared, not judged.
template <class N>
inline constexpr std::size_t kSurfaceBytes = N::kIsInteger ? SurfaceModel::kBytes : 0;
template <class N>
inline constexpr std::size_t kMeshBytes = N::kIsInteger ? SurfaceMesh::kMaxBytes : 0;
template <class N>
inline constexpr std::size_t kModelSections = kTensorCount<N> + (N::kIsInteger ? 2 : 0);
template <class N>
inline constexpr std::size_t kModelDataOffset = (kModelHeaderSize +
                                                 kModelSections<N> * kModelSectionEntrySize + 63) /
                                                64 * 64;
template <class N>
inline constexpr std::size_t kModelImageSize =
    kModelDataOffset<N> + kWeightBytes<N> + kSurfaceBytes<N> + kMeshBytes<N>;

struct ModelHeader {
  std::array<char, 32> target{};  // NUL-terminated name of the spacecraft the network was trained for
  DepthProjection projection;
  RangeNoise noise;        // of the sensor for which the network was calibrated
  Inertia<Fixed> inertia;  // of the target, for its motion models
  // Identifies the mission that the network was trained for; 0: not known. For the ground: flight ignores it.
  std::uint32_t mission_crc32 = 0;
  // Identifies the image: it covers the header and, through the sections' CRCs, all weights. Set by the
  // reader, ignored by the writer.
  std::uint32_t crc32 = 0;
};

// Why an image is refused. The values are part of the interface (docs/icd.md).
enum class ModelStatus : std::uint8_t {
  kOk = 0,
  kTooShort,      // fewer bytes than header and section table
  kBadMagic,      // not a model image
  kBadVersion,    // a format version that this program does not read
  kBadSize,       // impossible header size or number of sections, or total size not equal to the bytes given
  kBadHeaderCrc,  // header or section table damaged
  kBadArchitecture,  // intact, but of another network
  kBadTarget,        // of another spacecraft, or malformed target name
  kBadSection,       // section id, offset or size does not match the network
  kBadSectionCrc,    // weights damaged
  kBadValue,  // impossible depth projection or inertia; a weight that is not finite; integers with which a
              // sum could leave 32 bits; a shift out of range; too many points on the surface; a mesh of it
              // that SurfaceMesh::is_sound() refuses or that does not end in zeros
  kBadNumerics,  // intact, but fixed point where float32 is expected, or vice versa
};
const char* to_string(ModelStatus status);

// Hash of the sizes in shape::kHashed (FNV-1a, 32 bits).
std::uint32_t architecture_hash();

// Checks the whole image, then fills in header and weights. On any status other than kOk both are unchanged.
// Weights in fixed point are not copied: they are read from the image, which must stay in place.
// `expected_target`: NUL-terminated name, or nullptr to accept any. The checks run in the order of
// ModelStatus, with two exceptions: the numerics follow the header CRC, and the header's values precede the
// sections.
template <class N>
[[nodiscard]] ModelStatus read_model_image(const std::uint8_t* image, std::size_t size_bytes,
                                           const char* expected_target, ModelHeader& header,
                                           NetworkWeights<N>& weights);

// The two parts of read_model_image(). The check uses only the sizes of the tensors in `weights`. The image
// given to take_model_image() must have passed the check.
template <class N>
[[nodiscard]] ModelStatus check_model_image(const std::uint8_t* image, std::size_t size_bytes,
                                            const char* expected_target, const NetworkWeights<N>& weights);
template <class N>
void take_model_image(const std::uint8_t* image, ModelHeader& header, NetworkWeights<N>& weights);

// Points and mesh of the target's surface in an image that has passed the check; without points and without
// triangles in float32. The image must stay in place.
template <class N>
SurfaceModel surface_of(const std::uint8_t* image) {
  return N::kIsInteger ? SurfaceModel(image + (kModelImageSize<N> - kMeshBytes<N> - kSurfaceBytes<N>))
                       : SurfaceModel();
}
template <class N>
SurfaceMesh surface_mesh_of(const std::uint8_t* image) {
  return N::kIsInteger ? SurfaceMesh(image + (kModelImageSize<N> - kMeshBytes<N>)) : SurfaceMesh();
}

// The CRC-32 that identifies an image (ModelHeader::crc32), from an image that has passed the check.
std::uint32_t model_image_crc32(const std::uint8_t* image);

// Whether an image with an intact header is marked as float32. For selecting the estimator that reads it.
bool is_float32(const std::uint8_t* image, std::size_t size_bytes);

// Sets the target's name. Returns false and changes nothing if the name is empty, longer than 31 characters
// or not printable ASCII.
[[nodiscard]] bool set_target(ModelHeader& header, const char* name);

// The sections of the target's surface; nullptr: zeros, which stand for a shape that is not known.
struct TargetSurface {
  const std::uint8_t* points = nullptr;  // SurfaceModel::kBytes
  const std::uint8_t* mesh = nullptr;    // SurfaceMesh::kMaxBytes
};

// Writes an image and returns its size, kModelImageSize<N>. Returns 0 and writes nothing if `capacity` is
// smaller. The reader checks the values, not this function. Flight programs do not call it, so the linker
// leaves it out. `surface`: not used for float32 images, which have none.
template <class N>
[[nodiscard]] std::size_t write_model_image(const ModelHeader& header, const NetworkWeights<N>& weights,
                                            std::uint8_t* out, std::size_t capacity,
                                            const TargetSurface& surface = {});

}  // namespace tumblesight::gnc
