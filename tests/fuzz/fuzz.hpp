// A fuzz target is one file with LLVMFuzzerTestOneInput(). libFuzzer calls it with inputs that it generates,
// replay.cpp with the inputs of the corpus. It must return for every input; require() checks the conditions
// that must hold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace tumblesight::fuzz {

inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: does not hold: %s\n", what);
  std::abort();
}

// Reads little-endian numbers from an input, one after the other. Beyond its end they are zero.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : at_(data), left_(size) {}

  bool empty() const { return left_ == 0; }
  std::size_t left() const { return left_; }
  const std::uint8_t* rest() const { return at_; }
  std::uint8_t u8() { return static_cast<std::uint8_t>(number(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(number(2)); }
  std::uint32_t u24() { return static_cast<std::uint32_t>(number(3)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
  std::uint64_t u64() { return number(8); }
  std::string text() const { return {reinterpret_cast<const char*>(at_), left_}; }

 private:
  std::uint64_t number(int bytes) {
    std::uint64_t value = 0;
    for (int i = 0; i < bytes && left_ > 0; ++i, --left_) value |= std::uint64_t{*at_++} << (8 * i);
    return value;
  }

  const std::uint8_t* at_;
  std::size_t left_;
};

// Whether an input also goes through an expensive check: one input in `one_in`. A hash of its bytes decides,
// so that the answer is the same for the same input. In a replay of the corpus: every input.
inline bool is_chosen([[maybe_unused]] const Input& input, [[maybe_unused]] std::uint32_t one_in) {
#if TUMBLESIGHT_FUZZ
  std::uint32_t hash = 2166136261U;
  for (std::size_t i = 0; i < input.left(); ++i) hash = (hash ^ input.rest()[i]) * 16777619U;
  return (hash ^ hash >> 16U) % one_in == 0;
#else
  return true;
#endif
}

}  // namespace tumblesight::fuzz
