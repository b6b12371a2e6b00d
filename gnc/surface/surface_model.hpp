// SurfaceModel: points on the outer surface of the target, which the ground samples from its mesh
// (sim/surface/surface_samples.hpp). It is a section of the model image and is read where it lies.
//
// All numbers are little-endian. A section without points is all zeros: the target's shape is not known.
//   offset  size  field
//        0     4  number of points, 0 to 2048
//        4     4  spacing [mm]: no two points on surfaces of similar direction are closer, and no
//                 place of the surface is farther from its nearest point
//        8  9 n   points: x, y, z in the TRF, signed 16 bits, in units of the target's radius (model header)
//                 / 32767; then the outward normal, three times signed 8 bits, in units of 1 / 127
//        -     -  zeros up to 2048 points
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tumblesight::gnc {

struct SurfacePoint {
  std::array<std::int16_t, 3> position;  // in the TRF; 32767: one target radius
  std::array<std::int8_t, 3> normal;     // unit vector, times 127; zeros: not a point
};

class SurfaceModel {
 public:
  static constexpr int kMaxPoints = 2048;
  static constexpr int kRadius = 32767;
  static constexpr int kUnitNormal = 127;
  static constexpr std::size_t kHeaderBytes = 8;
  static constexpr std::size_t kPointBytes = 9;
  static constexpr std::size_t kBytes = kHeaderBytes + kPointBytes * kMaxPoints;

  SurfaceModel() = default;  // without points
  // `section`: kBytes that stay in place, or nullptr.
  explicit SurfaceModel(const std::uint8_t* section) : section_(section) {}

  bool is_known() const { return points() != 0; }
  std::uint32_t points() const { return section_ == nullptr ? 0 : u32_at(0); }
  std::uint32_t spacing_mm() const { return section_ == nullptr ? 0 : u32_at(4); }
  // Requires a section. Indices from points() to kMaxPoints - 1 give zeros.
  SurfacePoint point(int index) const {
    const std::uint8_t* at = section_ + kHeaderBytes + kPointBytes * static_cast<std::size_t>(index);
    return {
        {i16(at), i16(at + 2), i16(at + 4)},
        {static_cast<std::int8_t>(at[6]), static_cast<std::int8_t>(at[7]), static_cast<std::int8_t>(at[8])}};
  }

 private:
  static std::int16_t i16(const std::uint8_t* at) { return static_cast<std::int16_t>(at[0] | (at[1] << 8)); }
  std::uint32_t u32_at(std::size_t offset) const {
    const std::uint8_t* at = section_ + offset;
    return static_cast<std::uint32_t>(at[0]) | (static_cast<std::uint32_t>(at[1]) << 8) |
           (static_cast<std::uint32_t>(at[2]) << 16) | (static_cast<std::uint32_t>(at[3]) << 24);
  }

  const std::uint8_t* section_ = nullptr;
};

}  // namespace tumblesight::gnc
