// FakeFlashStore: two banks of flash. A write erases and programs in the background, takes ticks, makes its
// bank unreadable meanwhile, and can fail. Programming clears bits only, as in flash. Host only.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "hal/model_store.hpp"

namespace tumblesight::hal::fake {

class FakeFlashStore final : public ModelStore {
 public:
  static constexpr std::uint32_t kSectorBytes = 4096;

  explicit FakeFlashStore(const std::vector<std::uint8_t>& image) {
    for (Bank& bank : banks) {
      bank.cells = bank.visible = image;
      bank.size = image.size();
    }
  }

  ModelBank bank(int index) override {
    Bank& bank = banks[static_cast<std::size_t>(index)];
    return {bank.visible.data(), BankWriting::kInBackground, bank.size, bank.visible.size()};
  }
  WriteStatus write(int index, std::uint32_t offset, const std::uint8_t* bytes,
                    std::uint32_t count) override {
    Bank& bank = banks[static_cast<std::size_t>(index)];
    if (dead) return WriteStatus::kFailed;
    if (bank.ticks_left > 0) return WriteStatus::kBusy;
    if (count > bank.cells.size() || offset > bank.cells.size() - count) return WriteStatus::kRefused;
    bank.failed = false;
    bank.ticks_left = erase_ticks + write_ticks;
    bank.offset = offset;
    bank.pending.assign(bytes, bytes + count);
    std::fill(bank.visible.begin(), bank.visible.end(), std::uint8_t{0xA5});  // a status, not data
    if (bank.ticks_left == 0) finish(bank);
    return WriteStatus::kAccepted;
  }
  BankActivity activity(int index) override {
    const Bank& bank = banks[static_cast<std::size_t>(index)];
    if (bank.ticks_left > write_ticks) return BankActivity::kErasing;
    if (bank.ticks_left > 0) return BankActivity::kWriting;
    return bank.failed ? BankActivity::kFailed : BankActivity::kReady;
  }

  void tick() {
    for (Bank& bank : banks) {
      if (bank.ticks_left > 0 && --bank.ticks_left == 0) finish(bank);
    }
  }

  struct Bank {
    std::vector<std::uint8_t> cells;
    std::vector<std::uint8_t> visible;  // what a reader finds
    std::size_t size = 0;
    int ticks_left = 0;
    bool failed = false;
    std::uint32_t offset = 0;
    std::vector<std::uint8_t> pending;
  };
  std::array<Bank, kModelBanks> banks;
  int erase_ticks = 2;
  int write_ticks = 1;
  bool dead = false;       // refuses every write
  bool fail_next = false;  // the next accepted write fails after its erasure

 private:
  void finish(Bank& bank) {
    const std::uint32_t begin = bank.offset / kSectorBytes * kSectorBytes;
    const auto end = std::min<std::uint32_t>(
        (bank.offset + static_cast<std::uint32_t>(bank.pending.size()) + kSectorBytes - 1) / kSectorBytes *
            kSectorBytes,
        static_cast<std::uint32_t>(bank.cells.size()));
    std::vector<std::uint8_t> wanted(bank.cells.begin() + begin, bank.cells.begin() + end);
    std::copy(bank.pending.begin(), bank.pending.end(), wanted.begin() + (bank.offset - begin));
    std::fill(bank.cells.begin() + begin, bank.cells.begin() + end, std::uint8_t{0xFF});
    bank.failed = fail_next;
    for (std::uint32_t i = begin; i < end && !fail_next; ++i) bank.cells[i] &= wanted[i - begin];
    fail_next = false;
    bank.visible = bank.cells;
  }
};

}  // namespace tumblesight::hal::fake
