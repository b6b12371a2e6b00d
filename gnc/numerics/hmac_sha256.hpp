// HMAC-SHA-256 (RFC 2104, FIPS 180-4): proves that the sender of a telecommand has the key. The run time
// depends only on the length of the message.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tumblesight::gnc {

using Sha256Digest = std::array<std::uint8_t, 32>;

class Sha256 {
 public:
  void add(const std::uint8_t* data, std::size_t size_bytes);
  // Call once, after all add().
  Sha256Digest digest();

 private:
  void take_block();

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> block_{};
  std::uint64_t size_bytes_ = 0;
};

// For a message in parts. The key is padded with zeros to the block size.
class HmacSha256 {
 public:
  explicit HmacSha256(const std::array<std::uint8_t, 32>& key);
  void add(const std::uint8_t* data, std::size_t size_bytes) { inner_.add(data, size_bytes); }
  // Call once, after all add().
  Sha256Digest digest();

 private:
  std::array<std::uint8_t, 64> pad_{};
  Sha256 inner_;
};

// `message`: `size_bytes` bytes.
Sha256Digest hmac_sha256(const std::array<std::uint8_t, 32>& key, const std::uint8_t* message,
                         std::size_t size_bytes);

// Compares every byte, so that the run time does not show where the first difference is.
bool equal_in_constant_time(const std::uint8_t* a, const std::uint8_t* b, std::size_t size_bytes);

}  // namespace tumblesight::gnc
