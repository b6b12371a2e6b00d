// Place: where a file is written. Folders that others may write to, as /tmp, can hold links, pipes and files
// of another user, which lead astray who writes there. Everything that the tool writes goes through here.
//
// The rule: a link of another user is not followed, wherever it is in the path, unless its owner is root.
// Where root is the user of a container, a link is also followed if its owner owns the folder in which it is
// and nobody else may write there, as in a project folder that is mounted into a container. A pipe of another
// user is refused, and so is a file of another user that only its owner may replace.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/types.h>

#include <string>
#include <vector>

namespace tumblesight::sim {

enum class Folders { kAsTheyAre, kMade };  // what happens if a folder of the path does not exist

class Place {
 public:
  explicit Place(const std::string& path, Folders folders = Folders::kAsTheyAre);
  ~Place();
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  // Why nothing may or can be written there, and what to do. Empty if something can.
  const std::string& fault() const { return fault_; }
  // Its folder, after all links, as a descriptor: nobody can exchange it any more. Below 0: there is none, or
  // a fault.
  int folder() const { return folder_; }
  const std::string& name() const { return name_; }    // in this folder
  mode_t type() const { return type_; }                // S_IFREG and the like. 0: nothing is there
  bool is_link() const { return is_link_; }            // the path ends with a link
  bool is_of_kernel() const { return is_of_kernel_; }  // an open file, as /dev/stdout
  // Whether a new file may take the place of what is there. A device, a pipe or a link stays what it is.
  bool is_replaceable() const { return !is_link_ && (type_ == 0 || type_ == S_IFREG); }

 private:
  struct Walk;
  void step(Walk& walk);
  void take_last(Walk& walk, const std::string& name);
  void follow(Walk& walk, const std::string& name, int link);
  void enter(int folder);
  void fail(const std::string& what, int error);

  std::string fault_, name_;
  int folder_ = -1;
  mode_t type_ = 0;
  bool is_link_ = false, is_of_kernel_ = false;
};

// Opens the place for writing, with these flags of open(), and makes a file if there is none. What is
// open is judged again, so that nothing that was put there meanwhile is written to. Does not wait for the
// reader of a pipe. Throws std::runtime_error with the reason.
int open_place(const Place& place, int flags = O_WRONLY);
// The same. The message names the path.
int open_to_write(const std::string& path, const Place& place, int flags = O_WRONLY);
int open_to_write(const std::string& path, int flags = O_WRONLY);
// Empty, if it is a file.
int open_emptied(const std::string& path, const Place& place);

}  // namespace tumblesight::sim
