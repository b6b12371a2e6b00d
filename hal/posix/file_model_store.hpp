// FileModelStore: the model image of a file in both banks, read whole when the store is made. Later changes
// of the file do not reach it, nor do those of the banks reach the file.
#pragma once

#include "hal/model_store.hpp"

namespace tumblesight::hal::posix {

enum class FileStatus : std::uint8_t {
  kOk = 0,
  kMissing,     // no such file
  kUnreadable,  // no permission, not a regular file, or the reading failed
  kEmpty,
  kTooLarge,  // more bytes than allowed
  kNoMemory,
};
const char* to_string(FileStatus status);

class FileModelStore final : public ModelStore {
 public:
  // Maps memory for the banks, `max_bytes` each; the only time that it does.
  FileModelStore(const char* path, std::size_t max_bytes);
  ~FileModelStore();
  FileModelStore(const FileModelStore&) = delete;
  FileModelStore& operator=(const FileModelStore&) = delete;

  FileStatus status() const { return status_; }
  // Empty unless status() is kOk, and without memory only where there was none.
  ModelBank bank(int index) override;

 private:
  FileStatus load(int file, std::size_t max_bytes);

  std::uint8_t* data_ = nullptr;  // of the first bank; the second follows it
  std::size_t capacity_ = 0;      // of each
  std::size_t size_ = 0;
  FileStatus status_ = FileStatus::kMissing;
};

}  // namespace tumblesight::hal::posix
