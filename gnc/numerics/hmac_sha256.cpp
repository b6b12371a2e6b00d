#include "gnc/numerics/hmac_sha256.hpp"

namespace tumblesight::gnc {
namespace {

// FIPS 180-4, 4.2.2.
constexpr std::array<std::uint32_t, 64> kRound{
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

constexpr std::size_t kBlock = 64;
constexpr std::size_t kLengthField = 8;

std::uint32_t rotated(std::uint32_t x, int by) {
  return (x >> by) | (x << (32 - by));
}

std::uint32_t big_endian_word(const std::uint8_t* at) {
  return std::uint32_t{at[0]} << 24 | std::uint32_t{at[1]} << 16 | std::uint32_t{at[2]} << 8 | at[3];
}

}  // namespace

// FIPS 180-4, 6.2.2, with the last 16 words of the message schedule.
void Sha256::take_block() {
  std::array<std::uint32_t, 16> w;
  for (std::size_t t = 0; t < 16; ++t) w[t] = big_endian_word(block_.data() + 4 * t);
  auto [a, b, c, d, e, f, g, h] = state_;
  for (std::size_t t = 0; t < 64; ++t) {
    const std::uint32_t word = w[t % 16];
    const std::uint32_t t1 =
        h + (rotated(e, 6) ^ rotated(e, 11) ^ rotated(e, 25)) + ((e & f) ^ (~e & g)) + kRound[t] + word;
    const std::uint32_t t2 =
        (rotated(a, 2) ^ rotated(a, 13) ^ rotated(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
    h = g;
    g = f;
    f = e;
    e = d + t1;
    d = c;
    c = b;
    b = a;
    a = t1 + t2;
    const std::uint32_t w1 = w[(t + 1) % 16], w14 = w[(t + 14) % 16];
    w[t % 16] = word + (rotated(w1, 7) ^ rotated(w1, 18) ^ (w1 >> 3)) + w[(t + 9) % 16] +
                (rotated(w14, 17) ^ rotated(w14, 19) ^ (w14 >> 10));
  }
  const std::array<std::uint32_t, 8> change{a, b, c, d, e, f, g, h};
  for (std::size_t i = 0; i < 8; ++i) state_[i] += change[i];
}

void Sha256::add(const std::uint8_t* data, std::size_t size_bytes) {
  for (std::size_t i = 0; i < size_bytes; ++i) {
    block_[size_bytes_++ % kBlock] = data[i];
    if (size_bytes_ % kBlock == 0) take_block();
  }
}

Sha256Digest Sha256::digest() {
  const std::uint64_t size_bits = 8 * size_bytes_;
  constexpr std::uint8_t kEnd = 0x80, kZero = 0;
  add(&kEnd, 1);
  const std::size_t zeros = (2 * kBlock - kLengthField - size_bytes_ % kBlock) % kBlock;
  for (std::size_t i = 0; i < zeros; ++i) add(&kZero, 1);
  for (int shift = 56; shift >= 0; shift -= 8) {
    const auto byte = static_cast<std::uint8_t>(size_bits >> shift);
    add(&byte, 1);
  }
  Sha256Digest digest;
  for (std::size_t i = 0; i < digest.size(); ++i)
    digest[i] = static_cast<std::uint8_t>(state_[i / 4] >> (24 - 8 * (i % 4)));
  return digest;
}

HmacSha256::HmacSha256(const std::array<std::uint8_t, 32>& key) {
  for (std::size_t i = 0; i < pad_.size(); ++i) pad_[i] = (i < key.size() ? key[i] : 0) ^ 0x36;
  inner_.add(pad_.data(), pad_.size());
}

Sha256Digest HmacSha256::digest() {
  const Sha256Digest of_message = inner_.digest();
  for (std::uint8_t& byte : pad_) byte ^= 0x36 ^ 0x5c;
  Sha256 outer;
  outer.add(pad_.data(), pad_.size());
  outer.add(of_message.data(), of_message.size());
  return outer.digest();
}

Sha256Digest hmac_sha256(const std::array<std::uint8_t, 32>& key, const std::uint8_t* message,
                         std::size_t size_bytes) {
  HmacSha256 code(key);
  code.add(message, size_bytes);
  return code.digest();
}

bool equal_in_constant_time(const std::uint8_t* a, const std::uint8_t* b, std::size_t size_bytes) {
  std::uint8_t difference = 0;
  for (std::size_t i = 0; i < size_bytes; ++i)
    difference = static_cast<std::uint8_t>(difference | (a[i] ^ b[i]));
  return difference == 0;
}

}  // namespace tumblesight::gnc
