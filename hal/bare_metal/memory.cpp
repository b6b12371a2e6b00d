// The memory functions that compiled code may call, so that no C library is needed. They work on words where
// both operands are aligned.
#include <cstddef>
#include <cstdint>

namespace {

using Word [[gnu::may_alias]] = std::uintptr_t;
constexpr std::size_t kWord = sizeof(Word);

bool both_aligned(const void* a, const void* b) {
  return ((reinterpret_cast<std::uintptr_t>(a) | reinterpret_cast<std::uintptr_t>(b)) % kWord) == 0;
}

template <int kWords>
void copy_words(const std::uint8_t* in, std::uint8_t* out) {
#pragma GCC unroll 8
  for (int i = 0; i < kWords; ++i) reinterpret_cast<Word*>(out)[i] = reinterpret_cast<const Word*>(in)[i];
}

}  // namespace

extern "C" {

void* memcpy(void* to, const void* from, std::size_t size) {
  auto* out = static_cast<std::uint8_t*>(to);
  const auto* in = static_cast<const std::uint8_t*>(from);
  if (both_aligned(to, from)) {
    constexpr std::size_t kBlock = 8 * kWord;
    for (; size >= kBlock; size -= kBlock, in += kBlock, out += kBlock) copy_words<8>(in, out);
    for (; size >= kWord; size -= kWord, in += kWord, out += kWord) copy_words<1>(in, out);
  }
  while (size-- > 0) *out++ = *in++;
  return to;
}

void* memmove(void* to, const void* from, std::size_t size) {
  auto* out = static_cast<std::uint8_t*>(to);
  const auto* in = static_cast<const std::uint8_t*>(from);
  if (out <= in) return memcpy(to, from, size);  // forwards: an overlapping byte is read before it is written
  while (size-- > 0) out[size] = in[size];
  return to;
}

void* memset(void* to, int value, std::size_t size) {
  auto* out = static_cast<std::uint8_t*>(to);
  const auto byte = static_cast<std::uint8_t>(value);
  if (both_aligned(to, to)) {
    const Word word = ~Word{0} / 255 * byte;
    for (; size >= kWord; size -= kWord, out += kWord) *reinterpret_cast<Word*>(out) = word;
  }
  while (size-- > 0) *out++ = byte;
  return to;
}

int memcmp(const void* a, const void* b, std::size_t size) {
  const auto* left = static_cast<const std::uint8_t*>(a);
  const auto* right = static_cast<const std::uint8_t*>(b);
  for (; size > 0; --size, ++left, ++right) {
    if (*left != *right) return *left - *right;
  }
  return 0;
}

int strcmp(const char* a, const char* b) {
  for (; *a != '\0' && *a == *b; ++a, ++b) {
  }
  return static_cast<unsigned char>(*a) - static_cast<unsigned char>(*b);
}

}  // extern "C"
