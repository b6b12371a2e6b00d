// The ICD hash: CRC-32 of tumblesight.idl, the version of the interface. Programs with different hashes
// refuse each other.
#pragma once

#include <cstdint>
#include <string_view>

namespace tumblesight::hal::dds {

std::uint32_t icd_hash();
// The file itself.
std::string_view idl_text();

}  // namespace tumblesight::hal::dds
