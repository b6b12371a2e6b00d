// The version of the interface: CRC-32 of tumblesight.idl. Programs with unequal hashes refuse each other.
#pragma once

#include <cstdint>

namespace tumblesight::hal::dds {

std::uint32_t icd_hash();

}  // namespace tumblesight::hal::dds
