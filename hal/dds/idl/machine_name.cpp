#include "hal/dds/idl/machine_name.hpp"

#include <errno.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>

namespace tumblesight::hal::dds {
namespace {

// Those who watch, beside whom no more can. Nobody accepts them: a connection that waits also ends with its
// holder.
constexpr int kMostWatching = 16;

struct Address {
  sockaddr_un value{};
  socklen_t size = 0;  // 0: the name is too long
};
// In the abstract namespace: the first byte is zero.
Address address_of(const char* name) {
  static_assert(MachineName::kMaxLength < sizeof(sockaddr_un::sun_path));
  Address address;
  address.value.sun_family = AF_UNIX;
  const std::size_t length = std::strlen(name);
  if (length > MachineName::kMaxLength) return address;
  std::memcpy(address.value.sun_path + 1, name, length);
  address.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
  return address;
}

int make_socket() {
  return socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
}

bool is_own_user(int socket) {
  ucred peer{};
  socklen_t size = sizeof peer;
  return getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.uid == geteuid();
}

void close_socket(int& socket) {
  if (socket >= 0) close(socket);
  socket = -1;
}

}  // namespace

int MachineName::hold(const char* name) {
  release();
  const Address address = address_of(name);
  if (address.size == 0) return ENAMETOOLONG;
  socket_ = make_socket();
  if (socket_ < 0) return errno;
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&address.value), address.size) == 0) return 0;
  const int error = errno;
  release();
  return error;
}

int MachineName::let_watch() const {
  return listen(socket_, kMostWatching) == 0 ? 0 : errno;
}

void MachineName::release() {
  close_socket(socket_);
}

bool NameWatch::start(const char* name) {
  stop();
  const Address address = address_of(name);
  socket_ = make_socket();
  if (socket_ < 0 || address.size == 0) return false;
  const bool is_connected =
      connect(socket_, reinterpret_cast<const sockaddr*>(&address.value), address.size) == 0;
  // Another user may have taken the name, and could end the run by freeing it.
  if (is_connected && is_own_user(socket_)) return true;
  stop();
  return false;
}

void NameWatch::stop() {
  close_socket(socket_);
}

bool NameWatch::holder_ended() const {
  pollfd state{socket_, 0, 0};
  return socket_ >= 0 && poll(&state, 1, 0) > 0 && (state.revents & (POLLHUP | POLLERR)) != 0;
}

}  // namespace tumblesight::hal::dds
