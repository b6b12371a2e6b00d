// The version of the interface: CRC-32 of tumblesight.idl. Programs with unequal hashes refuse each other.
#pragma once

#include <cstdint>

namespace tumblesight::hal::dds {

extern const std::uint32_t kIcdHash;

}  // namespace tumblesight::hal::dds
