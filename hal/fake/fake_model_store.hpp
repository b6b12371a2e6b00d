// FakeModelStore: two banks in memory that a test can fill and damage. Host only.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hal/model_store.hpp"

namespace tumblesight::hal::fake {

class FakeModelStore final : public ModelStore {
 public:
  ModelBank bank(int index) override {
    Bank& bank = banks[static_cast<std::size_t>(index)];
    if (bank.memory.empty()) return {};
    const BankWriting writing = bank.writable ? BankWriting::kAtOnce : BankWriting::kReadOnly;
    return {bank.memory.data(), writing, bank.size, bank.memory.size()};
  }
  WriteStatus write(int index, std::uint32_t offset, const std::uint8_t* bytes,
                    std::uint32_t count) override {
    Bank& bank = banks[static_cast<std::size_t>(index)];
    if (!bank.writable) return WriteStatus::kRefused;
    if (bank.dead) return WriteStatus::kFailed;
    return write_at_once(bank.memory.data(), bank.memory.size(), offset, bytes, count);
  }
  // Puts `image` into both banks. Their capacity is its size.
  void fill(const std::vector<std::uint8_t>& image) {
    for (Bank& bank : banks) bank = {image, image.size(), true};
  }

  struct Bank {
    std::vector<std::uint8_t> memory;  // empty: the bank does not exist
    std::size_t size = 0;              // of the image at start-up, bytes
    bool writable = true;
    bool dead = false;  // it cannot be written, although it should
  };
  std::array<Bank, kModelBanks> banks;
};

}  // namespace tumblesight::hal::fake
