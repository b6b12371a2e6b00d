// TripleRedundant: a state that must survive a bit flip, in three copies (triple modular redundancy, TMR).
// Between two cycles the copies are equal. At the start of a cycle a vote sets every bit to its majority.
// Within a cycle only the first copy changes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace tumblesight::fsw {

template <class State>
class TripleRedundant {
  static_assert(std::is_trivially_copyable_v<State> && sizeof(State) % 4 == 0);

 public:
  State& operator*() { return copies_[0]; }
  State* operator->() { return copies_.data(); }
  const State* operator->() const { return copies_.data(); }

  // Sets the first copy to its initial state, from a constant: a temporary would be on the stack.
  void restart() {
    static constexpr State kInitial{};
    copies_[0] = kInitial;
  }

  // Sets all copies to the majority of every bit. Returns the number of 32-bit words that differed.
  std::uint32_t vote() {
    std::uint32_t corrected = 0;
    for (std::size_t at = 0; at < sizeof(State); at += 4) {
      const std::uint32_t a = word(0, at), b = word(1, at), c = word(2, at);
      const std::uint32_t majority = (a & b) | (c & (a | b));
      if (a == b && b == c) continue;
      ++corrected;
      for (std::size_t copy = 0; copy < 3; ++copy) put_word(copy, at, majority);
    }
    return corrected;
  }
  // Copies the first copy to the others, at the end of a cycle.
  void commit() {
    for (std::size_t copy = 1; copy < 3; ++copy) {
      std::memcpy(static_cast<void*>(&copies_[copy]), copies_.data(),
                  sizeof(State));  // including the padding
    }
  }

 private:
  std::uint32_t word(std::size_t copy, std::size_t at) const {
    std::uint32_t value = 0;
    std::memcpy(&value, reinterpret_cast<const std::uint8_t*>(&copies_[copy]) + at, 4);
    return value;
  }
  void put_word(std::size_t copy, std::size_t at, std::uint32_t value) {
    std::memcpy(reinterpret_cast<std::uint8_t*>(&copies_[copy]) + at, &value, 4);
  }

  std::array<State, 3> copies_{};
};

}  // namespace tumblesight::fsw
