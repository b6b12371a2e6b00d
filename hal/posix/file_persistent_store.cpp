#include "hal/posix/file_persistent_store.hpp"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
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

StoreStatus read_record(const char* path, StoredBytes& bytes) {
  const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return errno == ENOENT ? StoreStatus::kBlank : StoreStatus::kFailed;
  struct stat found {};
  StoreStatus status = StoreStatus::kFailed;
  if (fstat(file, &found) == 0 && S_ISREG(found.st_mode)) {
    const bool whole = transfer_whole(file, bytes.data(), bytes.size(), ::read);
    if (whole) status = StoreStatus::kOk;
    if (found.st_size != kStoredBytes) status = StoreStatus::kDamaged;
  }
  (void)close(file);
  return status;
}

// kUsable also if it does not exist.
StoreFileCheck check_kind(const char* path) {
  struct stat found {};
  if (lstat(path, &found) != 0)
    return errno == ENOENT ? StoreFileCheck{} : StoreFileCheck{StoreFileStatus::kFailed, path, errno};
  if (!S_ISREG(found.st_mode)) return {StoreFileStatus::kNotARegularFile, path, 0};
  if (found.st_size > kStoredBytes) return {StoreFileStatus::kNotARecord, path, 0};
  if (access(path, R_OK | W_OK) != 0) return {StoreFileStatus::kFailed, path, errno};
  return {};
}

StoreFileCheck check_record(const char* path, const std::uint8_t* magic, std::size_t size) {
  const StoreFileCheck kind = check_kind(path);
  if (kind.status != StoreFileStatus::kUsable) return kind;
  // A torn or older record begins as every record does; the application finds what is wrong with it.
  StoredBytes bytes{};
  const StoreStatus status = read_record(path, bytes);
  const bool readable = status == StoreStatus::kOk || status == StoreStatus::kDamaged;
  const bool record = readable && std::memcmp(bytes.data(), magic, size) == 0;
  return record || status == StoreStatus::kBlank ? StoreFileCheck{}
                                                 : StoreFileCheck{StoreFileStatus::kNotARecord, path, 0};
}

// A crash can leave a temporary file, whole or in part.
StoreFileCheck check_temporary(const char* temporary, const char* path) {
  const StoreFileCheck kind = check_kind(temporary);
  if (kind.status != StoreFileStatus::kUsable) return kind;
  const int file = open(temporary, O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0600);
  if (file < 0) return {StoreFileStatus::kFailed, path, errno};
  (void)close(file);
  (void)unlink(temporary);
  return {};
}

// The folder of `path`; `path` without it is returned.
const char* split(const char* path, char* folder, std::size_t size) {
  const char* const slash = std::strrchr(path, '/');
  if (slash == nullptr) {
    (void)snprintf(folder, size, ".");
    return path;
  }
  (void)snprintf(folder, size, "%.*s", slash == path ? 1 : static_cast<int>(slash - path), path);
  return slash + 1;
}

bool same_inode(const char* one, const char* other) {
  struct stat a {};
  struct stat b {};
  return stat(one, &a) == 0 && stat(other, &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

// Also of files that do not exist.
bool same_file(const char* one, const char* other) {
  char folder_of_one[FilePersistentStore::kMaxPath + 16];
  char folder_of_other[FilePersistentStore::kMaxPath + 16];
  const char* const name = split(one, folder_of_one, sizeof folder_of_one);
  const bool same_name = std::strcmp(name, split(other, folder_of_other, sizeof folder_of_other)) == 0;
  return (same_name && same_inode(folder_of_one, folder_of_other)) || same_inode(one, other);
}

}  // namespace

bool FilePersistentStore::use(const char* path) {
  const std::size_t length = std::strlen(path);
  if (length >= kMaxPath) return false;
  std::memcpy(paths_[0], path, length + 1);
  std::memcpy(paths_[1], path, length);
  std::memcpy(paths_[1] + length, ".copy", 6);
  for (int copy = 0; copy < kStoredCopies; ++copy)
    (void)snprintf(temporaries_[copy], kPathSize, "%.*s.new", kMaxPath + 8, paths_[copy]);
  (void)split(path, folder_, sizeof folder_);
  return true;
}

StoreFileCheck FilePersistentStore::check(const std::array<std::uint8_t, kMagicBytes>& magic) const {
  StoreFileCheck result;
  for (int copy = 0; copy < kStoredCopies && result.status == StoreFileStatus::kUsable; ++copy) {
    result = check_record(paths_[copy], magic.data(), magic.size());
    if (result.status == StoreFileStatus::kUsable) result = check_temporary(temporaries_[copy], paths_[copy]);
  }
  return result;
}

bool FilePersistentStore::uses(const char* path) const {
  bool used = false;
  for (int copy = 0; copy < kStoredCopies; ++copy)
    used = used || same_file(path, paths_[copy]) || same_file(path, temporaries_[copy]);
  return used;
}

StoreStatus FilePersistentStore::read(int copy, StoredBytes& bytes) {
  return read_record(paths_[copy], bytes);
}

StoreStatus FilePersistentStore::write(int copy, const StoredBytes& bytes) {
  const char* const temporary = temporaries_[copy];
  // Non-blocking: a named pipe that has taken this name since it was checked has no reader.
  const int file = open(temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0600);
  if (file < 0) return StoreStatus::kFailed;
  bool written = transfer_whole(file, bytes.data(), bytes.size(), ::write) && fsync(file) == 0;
  written = close(file) == 0 && written;
  written = written && rename(temporary, paths_[copy]) == 0 && sync_folder(folder_);
  return written ? StoreStatus::kOk : StoreStatus::kFailed;
}

}  // namespace tumblesight::hal::posix
