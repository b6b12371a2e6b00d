#include "hal/dds/idl/icd_hash.hpp"

#include "gnc/numerics/crc.hpp"

namespace tumblesight::hal::dds {
namespace {

constexpr unsigned char kIdl[] = {
#include "hal/dds/idl/idl_bytes.inc"
};

}  // namespace

std::uint32_t icd_hash() {
  return gnc::crc32(kIdl, sizeof kIdl);
}

std::string_view idl_text() {
  return {reinterpret_cast<const char*>(kIdl), sizeof kIdl};
}

}  // namespace tumblesight::hal::dds
