// FakeModelStore: two banks in memory, for the test to fill and to spoil. Host only.
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
    return {bank.memory.data(), bank.writable ? bank.memory.data() : nullptr, bank.size, bank.memory.size()};
  }
  // Both banks hold `image`, with room for nothing larger.
  void fill(const std::vector<std::uint8_t>& image) {
    for (Bank& bank : banks) bank = {image, image.size(), true};
  }

  struct Bank {
    std::vector<std::uint8_t> memory;  // empty: there is no such bank
    std::size_t size = 0;              // of the image at start
    bool writable = true;
  };
  std::array<Bank, kModelBanks> banks;
};

}  // namespace tumblesight::hal::fake
