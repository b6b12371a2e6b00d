// FakePersistentStore: two records in memory that outlive an application, and that a test can damage. Host
// only.
#pragma once

#include <array>
#include <vector>

#include "hal/persistent_store.hpp"

namespace tumblesight::hal::fake {

class FakePersistentStore final : public PersistentStore {
 public:
  StoreStatus read(int copy, StoredBytes& bytes) override {
    const auto at = static_cast<std::size_t>(copy);
    ++reads;
    if (unreadable[at]) return StoreStatus::kFailed;
    if (failing_reads[at] > 0) {
      --failing_reads[at];
      return StoreStatus::kFailed;
    }
    if (blank[at]) return StoreStatus::kBlank;
    bytes = copies[at];
    return StoreStatus::kOk;
  }
  StoreStatus write(int copy, const StoredBytes& bytes) override {
    const auto at = static_cast<std::size_t>(copy);
    if (writes == last_write) broken = {true, true};
    if (broken[at]) return StoreStatus::kFailed;
    ++writes;
    log.push_back({copy, bytes});
    if (protected_silently[at]) return StoreStatus::kOk;
    copies[at] = bytes;
    blank[at] = false;
    return unsure[at] ? StoreStatus::kFailed : StoreStatus::kOk;
  }

  std::array<StoredBytes, kStoredCopies> copies{};
  std::array<bool, kStoredCopies> blank{true, true};
  std::array<bool, kStoredCopies> broken{};              // no write succeeds
  std::array<bool, kStoredCopies> protected_silently{};  // a write changes nothing and reports no error
  std::array<bool, kStoredCopies> unsure{};  // a write reports an error, although its bytes can be read back
  std::array<bool, kStoredCopies> unreadable{};
  std::array<int, kStoredCopies> failing_reads{};  // that fail before one succeeds
  int last_write = -1;                             // after as many writes the store is broken
  struct Write {
    int copy;
    StoredBytes bytes;
  };
  std::vector<Write> log;  // of all writes
  int writes = 0;
  int reads = 0;
};

}  // namespace tumblesight::hal::fake
