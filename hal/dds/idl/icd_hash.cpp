#include "hal/dds/idl/icd_hash.hpp"

#include <cstddef>

namespace tumblesight::hal::dds {
namespace {

constexpr unsigned char kIdl[] = {
#include "hal/dds/idl/idl_bytes.inc"
};

// CRC-32 (IEEE 802.3, reflected) bit by bit: evaluated by the compiler.
constexpr std::uint32_t crc32_of_idl() {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (std::size_t i = 0; i < sizeof kIdl; ++i) {
    crc ^= kIdl[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

constexpr std::uint32_t kHash = crc32_of_idl();

}  // namespace

const std::uint32_t kIcdHash = kHash;

}  // namespace tumblesight::hal::dds
