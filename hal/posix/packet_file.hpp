// PacketFile: telemetry packets one after the other in a file, as ground systems read them: the length of
// each follows from its header.
#pragma once

#include <cstdint>

#include "hal/packets/packet_sink.hpp"

namespace tumblesight::hal::posix {

class PacketFile final : public packets::PacketSink {
 public:
  PacketFile() = default;
  ~PacketFile() { close(); }
  PacketFile(const PacketFile&) = delete;
  PacketFile& operator=(const PacketFile&) = delete;

  // Creates the file, or empties it. Returns 0 or the error number. EEXIST: the file exists and does not
  // begin with one of our packets; it stays unchanged. Devices and pipes are written as they are.
  [[nodiscard]] int open(const char* path);
  bool put(const packets::TelemetryPacket& packet) override;
  void close();

  std::uint32_t lost() const { return lost_; }  // packets that could not be written
  int error() const { return error_; }          // why the last of them could not

 private:
  int file_ = -1;
  int error_ = 0;
  std::uint32_t lost_ = 0;
};

}  // namespace tumblesight::hal::posix
