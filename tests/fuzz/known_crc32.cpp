// Stands before gnc::crc32() in programs that link it with --wrap: those of a patched image's sections as it
// says.
#include "tests/fuzz/patched_image.hpp"

// The linker's name of gnc::crc32(), and what it calls the one behind this.
extern "C" std::uint32_t __real__ZN11tumblesight3gnc5crc32EPKhm(const std::uint8_t* data,
                                                                std::size_t size_bytes);
extern "C" std::uint32_t __wrap__ZN11tumblesight3gnc5crc32EPKhm(const std::uint8_t* data,
                                                                std::size_t size_bytes) {
  std::uint32_t known;
  const tumblesight::fuzz::PatchedImage* const image = tumblesight::fuzz::the_image;
  const bool is_known = image != nullptr && image->knows_crc32(data, size_bytes, known);
  return is_known ? known : __real__ZN11tumblesight3gnc5crc32EPKhm(data, size_bytes);
}
