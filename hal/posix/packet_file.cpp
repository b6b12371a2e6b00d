#include "hal/posix/packet_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace tumblesight::hal::posix {

int PacketFile::open(const char* path) {
  close();
  constexpr mode_t kReadableByAll = 0644;
  file_ = ::open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kReadableByAll);
  return file_ < 0 ? errno : 0;
}

bool PacketFile::put(const packets::TelemetryPacket& packet) {
  std::size_t written = 0;
  while (written < packet.size) {
    const ssize_t count = ::write(file_, packet.bytes.data() + written, packet.size - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      error_ = errno;
      ++lost_;
      return false;
    }
    written += static_cast<std::size_t>(count);
  }
  return true;
}

void PacketFile::close() {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

}  // namespace tumblesight::hal::posix
