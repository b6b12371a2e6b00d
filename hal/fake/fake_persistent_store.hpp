// FakePersistentStore: two records in memory that outlive an application, and that a test can damage. Host
// only.
#pragma once

#include <array>

#include "hal/persistent_store.hpp"

namespace tumblesight::hal::fake {

class FakePersistentStore final : public PersistentStore {
 public:
  StoreStatus read(int copy, StoredBytes& bytes) override {
    const auto at = static_cast<std::size_t>(copy);
    if (unreadable[at]) return StoreStatus::kFailed;
    if (blank[at]) return StoreStatus::kBlank;
    bytes = copies[at];
    return StoreStatus::kOk;
  }
  StoreStatus write(int copy, const StoredBytes& bytes) override {
    const auto at = static_cast<std::size_t>(copy);
    if (broken[at]) return StoreStatus::kFailed;
    copies[at] = bytes;
    blank[at] = false;
    ++writes;
    return StoreStatus::kOk;
  }

  std::array<StoredBytes, kStoredCopies> copies{};
  std::array<bool, kStoredCopies> blank{true, true};
  std::array<bool, kStoredCopies> broken{};
  std::array<bool, kStoredCopies> unreadable{};
  int writes = 0;
};

}  // namespace tumblesight::hal::fake
