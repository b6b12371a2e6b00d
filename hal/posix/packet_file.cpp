#include "hal/posix/packet_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace tumblesight::hal::posix {

namespace {

// Packet identification and sequence control. In the first packet of a run its sequence count is 0.
constexpr std::size_t kHeaderBytes = 4;

bool is_first_header(const std::uint8_t* bytes) {
  packets::TelemetryEncoder encoder;
  const auto matches = [bytes](const packets::TelemetryPacket& packet) {
    return std::memcmp(bytes, packet.bytes.data(), kHeaderBytes) == 0;
  };
  return matches(encoder.encode(AttitudeReport{})) || matches(encoder.encode(Telemetry{})) ||
         matches(encoder.encode(Event{})) || matches(encoder.encode(MemoryDump{}));
}

// 0: it does not exist, is empty or holds packets, or it is no regular file.
int check_overwriting(const char* path) {
  struct stat found {};
  if (stat(path, &found) != 0 || !S_ISREG(found.st_mode) || found.st_size == 0) return 0;
  const int file = ::open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return errno;
  std::uint8_t header[kHeaderBytes] = {};
  const ssize_t count = ::read(file, header, sizeof header);
  (void)::close(file);
  return count == static_cast<ssize_t>(sizeof header) && is_first_header(header) ? 0 : EEXIST;
}

}  // namespace

int PacketFile::open(const char* path) {
  close();
  const int refusal = check_overwriting(path);
  if (refusal != 0) return refusal;
  constexpr mode_t kReadableByAll = 0644;
  // A pipe that nobody reads is refused (ENXIO), where opening it would wait for a reader.
  file_ = ::open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, kReadableByAll);
  if (file_ < 0) return errno;
  const int flags = fcntl(file_, F_GETFL);
  if (flags >= 0 && fcntl(file_, F_SETFL, flags & ~O_NONBLOCK) == 0) return 0;
  const int error = errno;
  close();
  return error;
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
