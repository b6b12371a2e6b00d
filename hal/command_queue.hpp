// CommandQueue: the telecommands that wait for the next cycle, behind a CommandFilter. For a link whose
// commands arrive in the thread of the cycle; DdsLink and QueueLink have the same between two threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "hal/command_filter.hpp"
#include "hal/fixed_queue.hpp"
#include "hal/link.hpp"

namespace tumblesight::hal {

template <std::size_t kPlaces>
class CommandQueue {
 public:
  static_assert(kPlaces > CommandFilter::kReserved, "a segment of a model needs a place");

  // See CommandFilter. Without a call of authenticate_with() the sender is trusted.
  void authenticate_with(const CommandKeys& keys, std::uint32_t slot, std::uint32_t last_counter) {
    filter_.authenticate_with(keys, slot, last_counter);
  }
  void follow(std::uint32_t slot, std::uint32_t last_counter) { filter_.follow(slot, last_counter); }

  // Queues the packet, or drops and counts it: false. A size beyond CommandPacket::kMaxBytes stays visible to
  // the application, which refuses it. Null is a packet without bytes.
  bool put(const std::uint8_t* bytes, std::size_t size_bytes) {
    const std::size_t size = bytes == nullptr ? 0 : size_bytes;
    incoming_.size = static_cast<std::uint16_t>(std::min<std::size_t>(size, UINT16_MAX));
    if (size > 0) std::copy_n(bytes, std::min(size, incoming_.bytes.size()), incoming_.bytes.begin());
    if (!filter_.passes(incoming_, waiting_.room())) return false;
    waiting_.push() = incoming_;
    return true;
  }
  // The oldest one. False: none waits.
  [[nodiscard]] bool receive(CommandPacket& command) {
    const CommandPacket* const oldest = waiting_.pop();
    if (oldest == nullptr) return false;
    command = *oldest;
    return true;
  }
  DroppedCommands take_dropped() { return filter_.take_dropped(); }

 private:
  CommandFilter filter_;
  CommandPacket incoming_;
  FixedQueue<CommandPacket, kPlaces> waiting_;
};

}  // namespace tumblesight::hal
