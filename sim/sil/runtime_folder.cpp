#include "sim/sil/runtime_folder.hpp"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

#include "sim/sil/failure.hpp"

namespace tumblesight::sim {
namespace {

constexpr mode_t kOwnerOnly = 0700;
constexpr mode_t kAccessOfOthers = 0077, kWriteOfOthers = 0022;

bool is_private_folder(const std::string& path) {
  struct stat status {};
  return !path.empty() && path[0] == '/' && stat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode) &&
         status.st_uid == geteuid() && (status.st_mode & kAccessOfOthers) == 0;
}

std::string path_of_user() {
  const char* const given = std::getenv("XDG_RUNTIME_DIR");
  if (given != nullptr && is_private_folder(given)) return std::string(given) + "/tumblesight";
  return "/tmp/tumblesight-" + std::to_string(geteuid());
}

[[noreturn]] void fail(const std::string& path, const std::string& fault,
                       const std::string& remedy = "remove it") {
  throw SilFailure("the folder " + path + ", in which runs and the console meet, " + fault + "; " + remedy +
                   ", or set XDG_RUNTIME_DIR to a folder of your own with mode 0700");
}

// Empty, or why others could use the folder.
std::string fault_of(int folder) {
  struct stat status {};
  if (fstat(folder, &status) != 0) return std::string("cannot be examined: ") + strerror(errno);
  if (status.st_uid != geteuid())
    return "belongs to another user (user id " + std::to_string(status.st_uid) + ")";
  if ((status.st_mode & kWriteOfOthers) != 0) return "can be written by other users";
  return {};
}

// Empty, or why its owner cannot use the folder.
std::string fault_of_use(int folder) {
  if (faccessat(folder, ".", R_OK | W_OK | X_OK, AT_EACCESS) == 0) return {};
  return std::string("cannot be used: ") + strerror(errno);
}

}  // namespace

RuntimeFolder::RuntimeFolder() : path_(path_of_user()) {
  if (mkdir(path_.c_str(), kOwnerOnly) != 0 && errno != EEXIST)
    fail(path_, std::string("cannot be made: ") + strerror(errno));
  folder_ = open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  const int error = errno;
  if (folder_ < 0 && (error == ENOTDIR || error == ELOOP)) fail(path_, "is no folder, but a file or a link");
  if (folder_ < 0) {
    struct stat status {};
    const bool is_of_another = lstat(path_.c_str(), &status) == 0 && status.st_uid != geteuid();
    if (!is_of_another && error == EACCES)
      fail(path_, std::string("cannot be used: ") + strerror(error), "chmod 700 " + path_);
    fail(path_, is_of_another ? "belongs to another user (user id " + std::to_string(status.st_uid) + ")"
                              : std::string("cannot be opened: ") + strerror(error));
  }
  const std::string fault = fault_of(folder_);
  const std::string no_use = fault.empty() ? fault_of_use(folder_) : "";
  if (fault.empty() && no_use.empty()) return;
  close(folder_);
  if (!no_use.empty()) fail(path_, no_use, "chmod 700 " + path_);
  fail(path_, fault);
}

RuntimeFolder::~RuntimeFolder() {
  if (folder_ >= 0) close(folder_);
}

int RuntimeFolder::open_file(const std::string& name) const {
  const int file = openat(folder_, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return -1;
  struct stat status {};
  if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid()) return file;
  close(file);
  return -1;
}

int RuntimeFolder::make_file(const std::string& name) const {
  unlinkat(folder_, name.c_str(), 0);
  return openat(folder_, name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
}

}  // namespace tumblesight::sim
