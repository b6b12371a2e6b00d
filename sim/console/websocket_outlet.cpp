#include "sim/console/websocket_outlet.hpp"

#include <civetweb.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

namespace tumblesight::sim {
namespace {

using Clock = std::chrono::steady_clock;

// Civetweb gives up a write in which nothing has gone out for request_timeout_ms, which is more. Sooner it
// says so only of a connection that is broken.
constexpr auto kShortestTimeout = std::chrono::milliseconds(500);

// Of a frame that is a whole message. That of a server has no mask.
std::string frame_head(int opcode, std::size_t size) {
  constexpr int kIsLast = 0x80, kSizeOf16Bits = 126, kSizeOf64Bits = 127;
  std::string head(1, static_cast<char>(kIsLast | opcode));
  int bytes = 0;
  if (size < kSizeOf16Bits) {
    head += static_cast<char>(size);
  } else {
    bytes = size <= UINT16_MAX ? 2 : 8;
    head += static_cast<char>(bytes == 2 ? kSizeOf16Bits : kSizeOf64Bits);
  }
  while (bytes-- > 0) head += static_cast<char>((std::uint64_t{size} >> (8 * bytes)) & 0xFF);
  return head;
}

}  // namespace

bool WebSocketOutlet::send(int opcode, std::string_view bytes) {
  const std::lock_guard lock(mutex_);
  if (has_failed_) return false;
  if (write(frame_head(opcode, bytes.size())) && write(bytes)) return true;
  // What follows half a message would be taken for its rest.
  has_failed_ = true;
  // So that the thread that reads ends the connection.
  mg_disable_connection_keep_alive(connection_);
  return false;
}

// In parts, so that it is seen in time that nobody waits any more.
bool WebSocketOutlet::write(std::string_view bytes) {
  constexpr std::size_t kPart = 65'536;
  for (auto progress = Clock::now(); !bytes.empty();) {
    const auto begin = Clock::now();
    const int count = mg_write(connection_, bytes.data(), std::min(kPart, bytes.size()));
    const auto now = Clock::now();
    if (count > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(count));
      progress = now;
    } else if (now - begin < kShortestTimeout || now - progress > patience_) {
      return false;
    }
    if (is_abandoned_ && !bytes.empty()) return false;
  }
  return true;
}

}  // namespace tumblesight::sim
