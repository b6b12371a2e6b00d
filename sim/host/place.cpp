#include "sim/host/place.hpp"

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace tumblesight::sim {
namespace {

constexpr int kMostLinks = 40;  // as Linux
constexpr const char* kOfAnother = " of another user; give another path";

// Root has no number where a container's user is not root and the kernel shows all foreign users as one.
bool is_in_container() {
  struct stat kernel {};
  return geteuid() == 0 || (stat("/proc/sys", &kernel) == 0 && kernel.st_uid != 0);
}

bool may_follow(const struct stat& link, const struct stat& folder) {
  if (link.st_uid == geteuid() || link.st_uid == 0) return true;
  const bool is_of_folder = link.st_uid == folder.st_uid && (folder.st_mode & (S_IWGRP | S_IWOTH)) == 0;
  return is_of_folder && is_in_container();
}

// As Linux's protected_fifos and protected_regular, which are not switched on everywhere.
std::string fault_of_found(const struct stat& found, const struct stat& folder) {
  if (S_ISDIR(found.st_mode)) return {};
  if (S_ISSOCK(found.st_mode)) return "it is a socket; give a file";
  if (found.st_uid == geteuid() || found.st_uid == 0) return {};
  if (S_ISFIFO(found.st_mode)) return std::string("it is a pipe") + kOfAnother;
  const bool is_kept = (folder.st_mode & S_ISVTX) != 0 && folder.st_uid != geteuid() && geteuid() != 0;
  return S_ISREG(found.st_mode) && is_kept ? std::string("it is a file") + kOfAnother : "";
}

// Its links are not text, but lead to what this process has open.
bool is_of_proc(int folder) {
  struct statfs system {};
  return fstatfs(folder, &system) == 0 && system.f_type == PROC_SUPER_MAGIC;
}

void add_names(std::vector<std::string>& left, const std::string& path) {
  std::vector<std::string> names;
  for (std::size_t at = 0; at < path.size();) {
    const std::size_t end = std::min(path.find('/', at), path.size());
    if (end > at && path.compare(at, end - at, ".") != 0) names.push_back(path.substr(at, end - at));
    at = end + 1;
  }
  left.insert(left.end(), names.rbegin(), names.rend());
}

}  // namespace

struct Place::Walk {
  std::vector<std::string> left;  // names, the next one at the end
  Folders folders = Folders::kAsTheyAre;
  int links = 0;
  bool is_over = false;
};

Place::Place(const std::string& path, Folders folders) {
  Walk walk;
  walk.folders = folders;
  add_names(walk.left, path);
  enter(open(path.compare(0, 1, "/") == 0 ? "/" : ".", O_PATH | O_DIRECTORY | O_CLOEXEC));
  while (!walk.left.empty() && !walk.is_over && folder_ >= 0) step(walk);
}

Place::~Place() {
  enter(-1);
}

void Place::enter(int folder) {
  if (folder_ >= 0) close(folder_);
  folder_ = folder;
}

void Place::fail(const std::string& what, int error) {
  fault_ = error == 0 ? what : what + ": " + std::strerror(error);
  enter(-1);
}

void Place::step(Walk& walk) {
  const std::string name = std::move(walk.left.back());
  walk.left.pop_back();
  const bool is_last = walk.left.empty();
  const bool is_made = !is_last && walk.folders == Folders::kMade;
  const int unmade = is_made && mkdirat(folder_, name.c_str(), 0777) != 0 ? errno : EEXIST;
  // A folder is opened as one, so that what is mounted on demand is mounted.
  const int flags = O_PATH | O_NOFOLLOW | O_CLOEXEC;
  const int folder = is_last ? -1 : openat(folder_, name.c_str(), flags | O_DIRECTORY);
  if (folder >= 0) return enter(folder);
  const int found = openat(folder_, name.c_str(), flags);
  struct stat status {};
  if (found >= 0 && fstat(found, &status) == 0 && S_ISLNK(status.st_mode)) {
    follow(walk, name, found);
  } else if (is_last) {
    take_last(walk, name);
  } else {
    const int error = found < 0 ? errno : ENOTDIR;
    if (error == ENOENT && walk.folders == Folders::kAsTheyAre) return enter(-1);  // it leads nowhere yet
    if (error == ENOENT && unmade != EEXIST)
      return fail("folder '" + name + "' of its path cannot be made", unmade);
    fail("'" + name + "' of its path cannot be entered; choose another folder", error);
  }
  if (found >= 0) close(found);
}

void Place::follow(Walk& walk, const std::string& name, int link) {
  struct stat status {
  }, folder{};
  if (fstat(link, &status) != 0 || fstat(folder_, &folder) != 0) return fail("it cannot be examined", errno);
  const bool is_last = walk.left.empty();
  if (!may_follow(status, folder))
    return fail((is_last && walk.links == 0 ? "it is a link" : "'" + name + "' of its path is a link") +
                    std::string(kOfAnother),
                0);
  if (++walk.links > kMostLinks) return fail("its path has too many links; give another path", 0);
  is_link_ = is_link_ || is_last;
  if (is_of_proc(folder_)) {
    is_of_kernel_ = is_last;
    if (is_last) return take_last(walk, name);
    const int entered = openat(folder_, name.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
    return entered < 0 ? fail("'" + name + "' of its path cannot be entered", errno) : enter(entered);
  }
  std::array<char, PATH_MAX> text{};
  const ssize_t size = readlinkat(link, "", text.data(), text.size());
  if (size <= 0) return fail("'" + name + "' of its path cannot be read", errno);
  add_names(walk.left, {text.data(), static_cast<std::size_t>(size)});
  if (text[0] == '/') enter(open("/", O_PATH | O_DIRECTORY | O_CLOEXEC));
}

void Place::take_last(Walk& walk, const std::string& name) {
  walk.is_over = true;
  name_ = name;
  struct stat status {
  }, folder{};
  if (fstatat(folder_, name.c_str(), &status, is_of_kernel_ ? 0 : AT_SYMLINK_NOFOLLOW) != 0) return;
  type_ = status.st_mode & S_IFMT;
  if (is_of_kernel_) return;
  const std::string fault =
      fstat(folder_, &folder) == 0 ? fault_of_found(status, folder) : std::strerror(errno);
  if (!fault.empty()) fail(fault, 0);
}

namespace {

// What opening it brought, which need not be what the place was.
std::string fault_of_opened(const Place& place, int file) {
  struct stat status {
  }, folder{};
  if (fstat(file, &status) != 0 || fstat(place.folder(), &folder) != 0) return std::strerror(errno);
  if (!place.is_of_kernel()) {
    const std::string fault = fault_of_found(status, folder);
    if (!fault.empty()) return fault;
  }
  const int flags = fcntl(file, F_GETFL);
  return flags >= 0 && fcntl(file, F_SETFL, flags & ~O_NONBLOCK) == 0 ? "" : std::strerror(errno);
}

std::string text_of_open_error(const Place& place, int error) {
  struct stat status {};
  const bool is_known = fstatat(place.folder(), place.name().c_str(), &status, 0) == 0;
  if (error == ENXIO && is_known && S_ISFIFO(status.st_mode))
    return "nobody reads this pipe; start its reader first, or give a file";
  if (error == ENXIO && is_known && S_ISSOCK(status.st_mode)) return "it is a socket; give a file";
  if (error == ELOOP) return "it has become a link; give another path";
  return std::strerror(error);
}

}  // namespace

int open_place(const Place& place, int flags) {
  if (!place.fault().empty()) throw std::runtime_error(place.fault());
  if (place.folder() < 0) throw std::runtime_error(std::strerror(ENOENT));
  const int following = place.is_of_kernel() ? 0 : O_NOFOLLOW;
  const int file = openat(place.folder(), place.name().c_str(),
                          O_CREAT | O_NONBLOCK | O_NOCTTY | O_CLOEXEC | following | flags, 0666);
  if (file < 0) throw std::runtime_error(text_of_open_error(place, errno));
  const std::string fault = fault_of_opened(place, file);
  if (fault.empty()) return file;
  close(file);
  throw std::runtime_error(fault);
}

int open_to_write(const std::string& path, const Place& place, int flags) {
  try {
    return open_place(place, flags);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error("cannot write '" + path + "': " + error.what());
  }
}

int open_emptied(const std::string& path, const Place& place) {
  const int file = open_to_write(path, place);
  struct stat status {};
  if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode) || ftruncate(file, 0) == 0) return file;
  const std::string reason = std::strerror(errno);
  close(file);
  throw std::runtime_error("cannot write '" + path + "': " + reason);
}

int open_to_write(const std::string& path, int flags) {
  return open_to_write(path, Place(path), flags);
}

}  // namespace tumblesight::sim
