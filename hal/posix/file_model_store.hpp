// FileModelStore: both model banks hold the image of a file, which is read completely by the constructor.
// Later changes to the file do not reach the banks, and changes to the banks do not reach the file.
#pragma once

#include "hal/model_store.hpp"

namespace tumblesight::hal::posix {

enum class FileStatus : std::uint8_t {
  kOk = 0,
  kMissing,     // no such file
  kUnreadable,  // no permission, not a regular file, or the reading failed
  kEmpty,
  kTooLarge,  // more than max_bytes
  kNoMemory,  // the system could not map the banks
};
const char* to_string(FileStatus status);

class FileModelStore final : public ModelStore {
 public:
  // Maps memory for the banks, `max_bytes` each, and reads the file. No other function allocates.
  FileModelStore(const char* path, std::size_t max_bytes);
  ~FileModelStore();
  FileModelStore(const FileModelStore&) = delete;
  FileModelStore& operator=(const FileModelStore&) = delete;

  FileStatus status() const { return status_; }
  // The bank has no image (size 0) unless status() is kOk, and no memory if status() is kNoMemory.
  ModelBank bank(int index) override;
  [[nodiscard]] WriteStatus write(int index, std::uint32_t offset, const std::uint8_t* bytes,
                                  std::uint32_t count) override;

 private:
  std::uint8_t* memory_of(int index) const { return data_ + static_cast<std::size_t>(index) * capacity_; }
  FileStatus load(int file, std::size_t max_bytes);

  std::uint8_t* data_ = nullptr;  // of the first bank; the second follows it
  std::size_t capacity_ = 0;      // of each
  std::size_t size_ = 0;
  FileStatus status_ = FileStatus::kMissing;
};

}  // namespace tumblesight::hal::posix
