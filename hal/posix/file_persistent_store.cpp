#include "hal/posix/file_persistent_store.hpp"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <cstring>

namespace tumblesight::hal::posix {
namespace {

// All bytes, or false.
template <class Bytes, class Transfer>
bool transfer_whole(int file, Bytes* bytes, std::size_t size, Transfer transfer) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count = transfer(file, bytes + done, size - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

bool sync_folder(const char* folder) {
  const int file = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return false;
  const bool synced = fsync(file) == 0;
  (void)close(file);
  return synced;
}

}  // namespace

bool FilePersistentStore::use(const char* path) {
  const std::size_t length = std::strlen(path);
  if (length >= kMaxPath) return false;
  std::memcpy(paths_[0], path, length + 1);
  std::memcpy(paths_[1], path, length);
  std::memcpy(paths_[1] + length, ".copy", 6);
  std::memcpy(folder_, path, length + 1);
  char* const slash = std::strrchr(folder_, '/');
  if (slash == nullptr) {
    std::memcpy(folder_, ".", 2);
  } else {
    slash[slash == folder_ ? 1 : 0] = '\0';
  }
  return true;
}

StoreStatus FilePersistentStore::read(int copy, StoredBytes& bytes) {
  const int file = open(paths_[copy], O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return errno == ENOENT ? StoreStatus::kBlank : StoreStatus::kFailed;
  std::uint8_t beyond = 0;
  bool whole = transfer_whole(file, bytes.data(), bytes.size(), ::read);
  whole = whole && ::read(file, &beyond, 1) == 0;
  (void)close(file);
  return whole ? StoreStatus::kOk : StoreStatus::kFailed;
}

StoreStatus FilePersistentStore::write(int copy, const StoredBytes& bytes) {
  char temporary[kMaxPath + 16];
  const std::size_t length = std::strlen(paths_[copy]);
  std::memcpy(temporary, paths_[copy], length);
  std::memcpy(temporary + length, ".new", 5);
  const int file = open(temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file < 0) return StoreStatus::kFailed;
  bool written = transfer_whole(file, bytes.data(), bytes.size(), ::write) && fsync(file) == 0;
  written = close(file) == 0 && written;
  written = written && rename(temporary, paths_[copy]) == 0 && sync_folder(folder_);
  return written ? StoreStatus::kOk : StoreStatus::kFailed;
}

}  // namespace tumblesight::hal::posix
