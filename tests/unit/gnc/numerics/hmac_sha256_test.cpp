// Test vectors of FIPS 180-4 and RFC 4231.
// Verifies TS-SEC-010.
#include "gnc/numerics/hmac_sha256.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace tumblesight::gnc {
namespace {

std::string hex(const Sha256Digest& digest) {
  std::string text;
  for (const std::uint8_t byte : digest) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

std::string sha256(const std::string& text) {
  Sha256 hash;
  hash.add(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  return hex(hash.digest());
}

TEST(Sha256, OfNothingAShortAndALongerMessage) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Sha256, OfAMillionBytesInPieces) {
  const std::vector<std::uint8_t> piece(977, 'a');
  Sha256 hash;
  for (std::size_t left = 1'000'000; left > 0;) {
    const std::size_t size = std::min(left, piece.size());
    hash.add(piece.data(), size);
    left -= size;
  }
  EXPECT_EQ(hex(hash.digest()), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(HmacSha256, OfRfc4231) {
  // Test cases 1 and 2; HMAC pads shorter keys with zeros.
  std::array<std::uint8_t, 32> key{};
  std::fill(key.begin(), key.begin() + 20, std::uint8_t{0x0b});
  const std::string hi = "Hi There";
  EXPECT_EQ(hex(hmac_sha256(key, reinterpret_cast<const std::uint8_t*>(hi.data()), hi.size())),
            "b0344c61d8db38535ca8afceaf0bf12b881dc200c9833da726e9376c2e32cff7");
  key = {'J', 'e', 'f', 'e'};
  const std::string what = "what do ya want for nothing?";
  EXPECT_EQ(hex(hmac_sha256(key, reinterpret_cast<const std::uint8_t*>(what.data()), what.size())),
            "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");
}

TEST(EqualInConstantTime, DetectsADifferenceInAnyByte) {
  const std::array<std::uint8_t, 4> a{1, 2, 3, 4};
  EXPECT_TRUE(equal_in_constant_time(a.data(), a.data(), a.size()));
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::array<std::uint8_t, 4> b = a;
    b[i] ^= 0x80;
    EXPECT_FALSE(equal_in_constant_time(a.data(), b.data(), a.size())) << i;
  }
}

}  // namespace
}  // namespace tumblesight::gnc
