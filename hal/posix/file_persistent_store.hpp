// FilePersistentStore: the two records in two files, PATH and PATH.copy. Each write replaces its file
// atomically, so that a crash leaves the old record or the new one.
#pragma once

#include "hal/persistent_store.hpp"

namespace tumblesight::hal::posix {

class FilePersistentStore final : public PersistentStore {
 public:
  static constexpr int kMaxPath = 1024;

  // False: the path is too long.
  bool use(const char* path);

  [[nodiscard]] StoreStatus read(int copy, StoredBytes& bytes) override;
  // Allocates nothing.
  [[nodiscard]] StoreStatus write(int copy, const StoredBytes& bytes) override;

 private:
  char paths_[kStoredCopies][kMaxPath + 8] = {};
  char folder_[kMaxPath] = {};
};

}  // namespace tumblesight::hal::posix
