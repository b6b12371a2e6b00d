// FileModelStore: one model image out of a file, read whole when the store is made. Later changes of the file
// do not reach it.
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
  // Maps memory for the image; the only time that it does.
  FileModelStore(const char* path, std::size_t max_bytes);
  ~FileModelStore();
  FileModelStore(const FileModelStore&) = delete;
  FileModelStore& operator=(const FileModelStore&) = delete;

  FileStatus status() const { return status_; }
  // None unless status() is kOk.
  ModelBytes active_image() override;

 private:
  FileStatus load(int file, std::size_t max_bytes);

  std::uint8_t* data_ = nullptr;
  std::size_t size_ = 0;
  FileStatus status_ = FileStatus::kMissing;
};

}  // namespace tumblesight::hal::posix
