// FilePersistentStore: the two records in two files, PATH and PATH.copy. Each write replaces its file
// atomically, so that a crash leaves the old record or the new one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/persistent_store.hpp"

namespace tumblesight::hal::posix {

// Whether a path can be used as the file of a record.
enum class StoreFileStatus : std::uint8_t {
  kUsable,
  kNotARegularFile,  // a folder, a device, a symbolic link: a write would replace it
  kNotARecord,       // a file with another size or another beginning: a write would destroy it
  kFailed,           // it cannot be read, or its folder cannot be written
};

struct StoreFileCheck {
  StoreFileStatus status = StoreFileStatus::kUsable;
  const char* path = "";  // what `status` is about
  int error = 0;          // with kFailed: the error number
};

class FilePersistentStore final : public PersistentStore {
 public:
  static constexpr int kMaxPath = 1024;

  static constexpr std::size_t kMagicBytes = 4;

  // False: the path is too long.
  bool use(const char* path);
  // Whether reads and writes will succeed and destroy nothing but records, which begin with `magic`. A file
  // that does not exist is usable. Call it before the first write.
  [[nodiscard]] StoreFileCheck check(const std::array<std::uint8_t, kMagicBytes>& magic) const;
  // Whether a write to `path` would change a file of this store, even one that does not exist yet.
  [[nodiscard]] bool uses(const char* path) const;

  [[nodiscard]] StoreStatus read(int copy, StoredBytes& bytes) override;
  // Allocates nothing.
  [[nodiscard]] StoreStatus write(int copy, const StoredBytes& bytes) override;

 private:
  static constexpr std::size_t kPathSize = kMaxPath + 16;

  char paths_[kStoredCopies][kPathSize] = {};
  char temporaries_[kStoredCopies][kPathSize] = {};  // written and then renamed
  char folder_[kMaxPath] = {};
};

}  // namespace tumblesight::hal::posix
