// MachineName: a name that at most one process holds at a time. It is an abstract Unix socket, without a
// file: permissions of folders do not matter, opening it cannot block, and the kernel frees the name however
// its holders end. All users of the network namespace share these names, like the UDP ports of the DDS
// domains.
#pragma once

namespace tumblesight::hal::dds {

class MachineName {
 public:
  MachineName() = default;
  ~MachineName() { release(); }
  MachineName(const MachineName&) = delete;
  MachineName& operator=(const MachineName&) = delete;

  // 0, or an errno value; EADDRINUSE: another process, or this one, holds the name. At most kMaxLength
  // characters.
  [[nodiscard]] int hold(const char* name);
  // From now on who watches the name (NameWatch) sees when the last holder ends. 0, or an errno value.
  [[nodiscard]] int let_watch() const;
  void release();
  // For a child process that inherits it, which is a holder too. -1: the name is not held.
  int descriptor() const { return socket_; }

  static constexpr unsigned kMaxLength = 100;

 private:
  int socket_ = -1;
};

// Watches the holder of a name from another process, also from one with process ids of its own, as in a
// container.
class NameWatch {
 public:
  NameWatch() = default;
  ~NameWatch() { stop(); }
  NameWatch(const NameWatch&) = delete;
  NameWatch& operator=(const NameWatch&) = delete;

  // False: the name is not held by a process of this user, or its holder does not let it be watched.
  bool start(const char* name);
  void stop();
  bool holder_ended() const;  // false without a watch

 private:
  int socket_ = -1;
};

}  // namespace tumblesight::hal::dds
