// RuntimeFolder: the folder in which the runs and the other programs of one user find each other:
// $XDG_RUNTIME_DIR/tumblesight, or /tmp/tumblesight-UID where that variable names no private folder of the
// user. TMPDIR does not matter, so that all programs find the same one. Nobody but the user can place,
// replace or lock a file in it.
#pragma once

#include <string>

namespace tumblesight::sim {

class RuntimeFolder {
 public:
  // Makes the folder if there is none. Throws SilFailure with its name and the remedy if it cannot be made,
  // is no folder of this user, or others may write to it.
  RuntimeFolder();
  ~RuntimeFolder();
  RuntimeFolder(const RuntimeFolder&) = delete;
  RuntimeFolder& operator=(const RuntimeFolder&) = delete;

  int descriptor() const { return folder_; }
  std::string path_of(const std::string& name) const { return path_ + "/" + name; }
  // A regular file of this user, for reading. -1: there is none of that name. Does not block on anything else
  // of that name, such as a FIFO.
  int open_file(const std::string& name) const;
  // Creates a new one for writing and replaces what has the name. -1: see errno.
  int make_file(const std::string& name) const;

 private:
  std::string path_;
  int folder_ = -1;
};

}  // namespace tumblesight::sim
