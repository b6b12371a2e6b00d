// Replaces gnc::crc32() in programs linked with --wrap: for the sections of a patched image, the CRC is the
// one that the image gives.
#include "tests/fuzz/patched_image.hpp"

// The linker's names of the original gnc::crc32() and of its replacement.
extern "C" std::uint32_t __real__ZN11tumblesight3gnc5crc32EPKhm(const std::uint8_t* data,
                                                                std::size_t size_bytes);
extern "C" std::uint32_t __wrap__ZN11tumblesight3gnc5crc32EPKhm(const std::uint8_t* data,
                                                                std::size_t size_bytes) {
  std::uint32_t known;
  const tumblesight::fuzz::PatchedImage* const image = tumblesight::fuzz::the_image;
  const bool is_known = image != nullptr && image->knows_crc32(data, size_bytes, known);
  return is_known ? known : __real__ZN11tumblesight3gnc5crc32EPKhm(data, size_bytes);
}
