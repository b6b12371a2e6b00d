// The ICD hash: CRC-32 of tumblesight.idl, the version of the interface. Programs with different hashes
// refuse each other.
#pragma once

#include <cstdint>

namespace tumblesight::hal::dds {

std::uint32_t icd_hash();

}  // namespace tumblesight::hal::dds
