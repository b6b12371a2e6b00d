// Layout of a model image in memory (model_image.hpp): what its reader, its writer and the check of its
// values share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "gnc/numerics/crc.hpp"
#include "gnc/rcnn/model_image.hpp"

namespace tumblesight::gnc::model_format {

inline constexpr std::array<std::uint8_t, 4> kMagic{'T', 'S', 'R', 'M'};
inline constexpr std::size_t kOffsetVersion = 4;
inline constexpr std::size_t kOffsetHeaderSize = 6;
inline constexpr std::size_t kOffsetTotalSize = 8;
inline constexpr std::size_t kOffsetArchitecture = 12;
inline constexpr std::size_t kOffsetTarget = 16;
inline constexpr std::size_t kOffsetSwath = 48;
inline constexpr std::size_t kOffsetRadius = 52;
inline constexpr std::size_t kOffsetNoise = 56;
inline constexpr std::size_t kOffsetInertia = 60;
inline constexpr std::size_t kOffsetNumerics = 84;
inline constexpr std::size_t kOffsetSectionCount = 88;
inline constexpr std::size_t kOffsetHeaderCrc = 92;

static_assert(sizeof(float) == 4);

inline std::uint16_t get_u16(const std::uint8_t* at) {
  return static_cast<std::uint16_t>(at[0] | (at[1] << 8));
}

inline std::uint32_t get_u32(const std::uint8_t* at) {
  return static_cast<std::uint32_t>(at[0]) | (static_cast<std::uint32_t>(at[1]) << 8) |
         (static_cast<std::uint32_t>(at[2]) << 16) | (static_cast<std::uint32_t>(at[3]) << 24);
}

inline float get_f32(const std::uint8_t* at) {
  const std::uint32_t bits = get_u32(at);
  float value = 0.0F;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

inline void put_u16(std::uint8_t* at, std::uint16_t value) {
  at[0] = static_cast<std::uint8_t>(value);
  at[1] = static_cast<std::uint8_t>(value >> 8);
}

inline void put_u32(std::uint8_t* at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) at[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

inline void put_f32(std::uint8_t* at, float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  put_u32(at, bits);
}

constexpr std::size_t data_offset(std::size_t sections) {
  return (kModelHeaderSize + sections * kModelSectionEntrySize + 63) / 64 * 64;
}

// Of the mission's CRC-32.
constexpr std::size_t mission_offset(std::size_t sections) {
  return data_offset(sections) - 4;
}
static_assert(mission_offset(kModelSections<FixedPoint>) >=
              kModelHeaderSize + kModelSections<FixedPoint> * kModelSectionEntrySize);
static_assert(mission_offset(kModelSections<Float32>) >=
              kModelHeaderSize + kModelSections<Float32> * kModelSectionEntrySize);

inline std::uint32_t header_crc(const std::uint8_t* image, std::size_t sections) {
  Crc32 crc;
  crc.add(image, kOffsetHeaderCrc);
  crc.add(image + kModelHeaderSize, data_offset(sections) - kModelHeaderSize);
  return crc.value();
}

// xx, yy, zz, xy, xz, yz.
inline constexpr std::array<std::array<int, 2>, 6> kInertiaElements{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};

template <class N>
constexpr std::uint32_t numerics_of() {
  return N::kIsInteger ? 1 : 0;
}

// Bytes of a tensor in the image: one per weight in fixed point, which is read in place; four per number
// otherwise.
template <std::size_t kCount>
constexpr std::size_t size_in_image(const FixedPoint::Weights<kCount>&) {
  return kCount;
}
template <class Number, std::size_t kCount>
constexpr std::size_t size_in_image(const std::array<Number, kCount>&) {
  return 4 * kCount;
}

}  // namespace tumblesight::gnc::model_format
