// The model image: the trained network as one file or memory region, with all that is needed to refuse a
// wrong one.
//
// Layout, little-endian everywhere; floats are IEEE 754 binary32:
//   offset  size  field
//        0     4  magic "TSRM"
//        4     2  format version (2)
//        6     2  header size (92)
//        8     4  total size of the image in bytes
//       12     4  architecture hash: network_shape.hpp and the numerics (float32)
//       16    32  target name, printable ASCII, NUL-padded, at least one NUL
//       48     4  depth projection: swath [m], float
//       52     4  depth projection: target radius [m], float
//       56     4  depth projection: encoding
//       60    24  inertia of the target in the TRF, only ratios matter: xx, yy, zz, xy, xz, yz, float
//       84     4  number of sections (21)
//       88     4  CRC-32 of bytes 0..87 and the section table
//       92  16 n  section table: id (1, 2, ...), offset, size in bytes, CRC-32 of the section, 4 bytes each
//      428     -  sections without gaps: the tensors in the order of for_each_tensor()
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "gnc/attitude/motion.hpp"
#include "gnc/lidar/depth_image.hpp"
#include "gnc/rcnn/network.hpp"

namespace tumblesight::gnc {

inline constexpr std::uint16_t kModelFormatVersion = 2;
inline constexpr std::size_t kModelHeaderSize = 92;
inline constexpr std::size_t kModelSectionEntrySize = 16;
inline constexpr std::size_t kModelDataOffset = kModelHeaderSize + kTensorCount * kModelSectionEntrySize;
inline constexpr std::size_t kModelImageSize = kModelDataOffset + kParameterCount * sizeof(float);

struct ModelHeader {
  std::array<char, 32> target{};  // NUL-terminated name of the spacecraft the network was trained for
  DepthProjection projection;
  Inertia inertia;  // how the target tumbles
  // Covers the header and, through the sections' CRCs, all weights: it names this very image. Set by the
  // reader.
  std::uint32_t crc32 = 0;
};

enum class ModelStatus : std::uint8_t {
  kOk = 0,
  kTooShort,    // fewer bytes than header and section table
  kBadMagic,    // not a model image
  kBadVersion,  // of a format this program does not read
  kBadSize,     // header size, number of sections or total size impossible, or not the number of bytes given
  kBadHeaderCrc,     // header or section table damaged
  kBadArchitecture,  // a whole image, but of another network
  kBadTarget,        // of another spacecraft, or its name is malformed
  kBadSection,       // section id, offset or size not as the network demands
  kBadSectionCrc,    // weights damaged
  kBadValue,         // a weight that is not finite, an impossible depth projection or inertia
};
const char* to_string(ModelStatus status);

// Hash of everything that gives the numbers of an image their meaning.
std::uint32_t architecture_hash();

// Checks the whole image, then takes over header and weights; on any other status than kOk both are
// untouched. `expected_target`: NUL-terminated name, or nullptr to accept any. Checks come in the order of
// ModelStatus, but the depth projection's values before the sections.
[[nodiscard]] ModelStatus read_model_image(const std::uint8_t* image, std::size_t size_bytes,
                                           const char* expected_target, ModelHeader& header,
                                           NetworkWeights& weights);

// Names the target. False, and nothing done, if the name is empty, too long or not printable ASCII.
[[nodiscard]] bool set_target(ModelHeader& header, const char* name);

// Bytes written: kModelImageSize, or 0 if `capacity` is less. The contents are not judged; the reader does
// that.
[[nodiscard]] std::size_t write_model_image(const ModelHeader& header, const NetworkWeights& weights,
                                            std::uint8_t* out, std::size_t capacity);

}  // namespace tumblesight::gnc
