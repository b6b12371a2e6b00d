// The model image: the trained network as one file or memory region, with all that is needed to refuse a
// wrong one.
//
// Layout, little-endian everywhere; floats are IEEE 754 binary32, and stand in the weights of float32 only:
//   offset  size  field
//        0     4  magic "TSRM"
//        4     2  format version (3)
//        6     2  header size (96)
//        8     4  total size of the image in bytes
//       12     4  architecture hash: network_shape.hpp
//       16    32  target name, printable ASCII, NUL-padded, at least one NUL
//       48     4  depth projection: swath [mm]
//       52     4  depth projection: target radius [mm]
//       56     4  reserved, 0
//       60    24  inertia of the target in the TRF, scaled to a trace of 3, with 24 bits behind the point:
//       xx, yy,
//                 zz, xy, xz, yz
//       84     4  numerics: 0 float32, 1 fixed point
//       88     4  number of sections: 21 or 31
//       92     4  CRC-32 of bytes 0..91, the section table and the zeros behind it
//       96  16 n  section table: id (1, 2, ...), offset, size in bytes, CRC-32 of the section, 4 bytes each
//        -     -  zeros up to the next multiple of 64, where the first section begins
//        -     -  sections without gaps: the tensors in the order of for_each_tensor(). Weights in fixed
//        point take
//                 one byte each, all else four
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "gnc/attitude/motion.hpp"
#include "gnc/lidar/depth_image.hpp"
#include "gnc/rcnn/network.hpp"

namespace tumblesight::gnc {

inline constexpr std::uint16_t kModelFormatVersion = 3;
inline constexpr std::size_t kModelHeaderSize = 96;
inline constexpr std::size_t kModelSectionEntrySize = 16;
template <class N>
inline constexpr std::size_t kModelDataOffset = (kModelHeaderSize + kTensorCount<N> * kModelSectionEntrySize +
                                                 63) /
                                                64 * 64;
template <class N>
inline constexpr std::size_t kModelImageSize = kModelDataOffset<N> + kWeightBytes<N>;

struct ModelHeader {
  std::array<char, 32> target{};  // NUL-terminated name of the spacecraft the network was trained for
  DepthProjection projection;
  Inertia<Fixed> inertia;  // how the target tumbles
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
  kBadValue,  // an impossible depth projection or inertia; a weight that is not finite; integers with which a
              // sum could leave 32 bits, or a shift out of its range
  kBadNumerics,  // a whole image, but fixed point where float32 is wanted, or the other way round
};
const char* to_string(ModelStatus status);

// Hash of everything that gives the numbers of an image their meaning.
std::uint32_t architecture_hash();

// Checks the whole image, then takes over header and weights; on any other status than kOk both are
// untouched. Weights in fixed point stay in the image and are read there. `expected_target`: NUL-terminated
// name, or nullptr to accept any. Checks come in the order of ModelStatus, but the depth projection's values
// before the sections.
template <class N>
[[nodiscard]] ModelStatus read_model_image(const std::uint8_t* image, std::size_t size_bytes,
                                           const char* expected_target, ModelHeader& header,
                                           NetworkWeights<N>& weights);

// The two halves of that. `weights` only lends the sizes of its tensors to the check; what is taken over must
// have been checked.
template <class N>
[[nodiscard]] ModelStatus check_model_image(const std::uint8_t* image, std::size_t size_bytes,
                                            const char* expected_target, const NetworkWeights<N>& weights);
template <class N>
void take_model_image(const std::uint8_t* image, ModelHeader& header, NetworkWeights<N>& weights);

// The CRC-32 in an image's header, which names it. Of an image that has been checked.
std::uint32_t model_image_crc32(const std::uint8_t* image);

// Whether an image says of itself that it is one in float32; for choosing by which estimator to read it.
bool is_float32(const std::uint8_t* image, std::size_t size_bytes);

// Names the target. False, and nothing done, if the name is empty, too long or not printable ASCII.
[[nodiscard]] bool set_target(ModelHeader& header, const char* name);

// Bytes written: kModelImageSize, or 0 if `capacity` is less. The contents are not judged; the reader does
// that.
template <class N>
[[nodiscard]] std::size_t write_model_image(const ModelHeader& header, const NetworkWeights<N>& weights,
                                            std::uint8_t* out, std::size_t capacity);

}  // namespace tumblesight::gnc
