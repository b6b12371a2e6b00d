#include "hal/posix/file_model_store.hpp"

#include <errno.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>

namespace tumblesight::hal::posix {
namespace {

// False if the file ends early or cannot be read.
bool read_whole(int file, std::uint8_t* data, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count = read(file, data + done, size - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

}  // namespace

const char* to_string(FileStatus status) {
  switch (status) {
    case FileStatus::kOk:
      return "ok";
    case FileStatus::kMissing:
      return "no such file";
    case FileStatus::kUnreadable:
      return "cannot be read";
    case FileStatus::kEmpty:
      return "the file is empty";
    case FileStatus::kTooLarge:
      return "the file is too large for a model image";
    case FileStatus::kNoMemory:
      return "no memory for the model banks";
  }
  return "unknown";
}

FileModelStore::FileModelStore(const char* path, std::size_t max_bytes) {
  // Pages take memory only when they are written.
  void* memory =
      mmap(nullptr, kModelBanks * max_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) {
    status_ = FileStatus::kNoMemory;
    return;
  }
  data_ = static_cast<std::uint8_t*>(memory);
  capacity_ = max_bytes;
  // Non-blocking, so that a named pipe in place of the image does not block the start-up.
  const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) {
    status_ = errno == ENOENT || errno == ENOTDIR ? FileStatus::kMissing : FileStatus::kUnreadable;
    return;
  }
  status_ = load(file, max_bytes);
  (void)close(file);
}

FileModelStore::~FileModelStore() {
  if (data_ != nullptr) (void)munmap(data_, kModelBanks * capacity_);
}

FileStatus FileModelStore::load(int file, std::size_t max_bytes) {
  struct stat about {};
  if (fstat(file, &about) != 0 || !S_ISREG(about.st_mode)) return FileStatus::kUnreadable;
  if (about.st_size <= 0) return FileStatus::kEmpty;
  const auto size = static_cast<std::size_t>(about.st_size);
  if (size > max_bytes) return FileStatus::kTooLarge;

  if (!read_whole(file, data_, size)) return FileStatus::kUnreadable;
  std::memcpy(data_ + capacity_, data_, size);
  size_ = size;
  return FileStatus::kOk;
}

ModelBank FileModelStore::bank(int index) {
  if (data_ == nullptr) return {};
  return {memory_of(index), BankWriting::kAtOnce, size_, capacity_};
}

WriteStatus FileModelStore::write(int index, std::uint32_t offset, const std::uint8_t* bytes,
                                  std::uint32_t count) {
  if (data_ == nullptr) return WriteStatus::kRefused;
  return write_at_once(memory_of(index), capacity_, offset, bytes, count);
}

}  // namespace tumblesight::hal::posix
