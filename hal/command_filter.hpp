// CommandFilter: what a link asks before it queues a telecommand. Forged and replayed packets never take a
// place in the queue, so a flood of them cannot keep genuine commands out. The last places of the queue are
// kept: a load of a model cannot keep other commands out, and nothing can keep SET_MODE SAFE out. Every drop
// is counted.
//
// The filter keeps three copies of the keys and outvotes a bit flip at each use.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "hal/command_authentication.hpp"
#include "hal/link.hpp"
#include "hal/messages/function_code.hpp"
#include "hal/messages/mode.hpp"

namespace tumblesight::hal {

class CommandFilter {
 public:
  // Without this call the link is trusted: every packet passes. `slot`, `last_counter`: those of the
  // application after its boot.
  void authenticate_with(const CommandKeys& keys, std::uint32_t slot, std::uint32_t last_counter) {
    copies_.fill({keys, slot, last_counter, 1});
  }
  // With the telemetry of each cycle: the application's key slot and counter.
  void follow(std::uint32_t slot, std::uint32_t last_counter) {
    State state = vote();
    if (slot != state.slot || last_counter > state.last_counter) state.last_counter = last_counter;
    state.slot = slot;
    copies_.fill(state);
  }

  // Whether the packet may take a place in a queue with `room` free places. The last kReserved places are not
  // for segments of a model. The last kReservedForSafe are for SET_MODE SAFE alone.
  bool passes(const CommandPacket& packet, std::size_t room) {
    State state = vote();
    CommandOrigin origin{true, CommandRefusal::kNoRoom, 0};
    if (state.authenticates != 0) origin = origin_of(packet, state.keys, state.slot, state.last_counter);
    if (origin.authentic && room <= places_kept_from(packet, state.authenticates != 0))
      origin = {false, CommandRefusal::kNoRoom, 0};
    if (!origin.authentic) {
      ++dropped_.by[static_cast<std::size_t>(origin.why)];
      return false;
    }
    if (state.authenticates != 0) state.last_counter = origin.counter;
    copies_.fill(state);
    return true;
  }

  DroppedCommands take_dropped() {
    const DroppedCommands dropped = dropped_;
    dropped_ = {};
    return dropped;
  }

  static constexpr std::size_t kReserved = 4;
  static constexpr std::size_t kReservedForSafe = 1;  // of these

 private:
  friend struct CommandFilterMemory;  // tests: the place where they flip bits

  struct State {
    CommandKeys keys;
    std::uint32_t slot = 0;
    std::uint32_t last_counter = 0;
    std::uint32_t authenticates = 0;
  };
  static_assert(sizeof(State) == 144, "padding would not be voted on");

  static std::size_t places_kept_from(const CommandPacket& packet, bool has_trailer) {
    const bool is_segment =
        packet.size > kCommandFunctionOffset &&
        packet.bytes[kCommandFunctionOffset] == static_cast<std::uint8_t>(FunctionCode::kModelLoad);
    if (is_segment) return kReserved;
    return is_set_mode_safe(packet, has_trailer) ? 0 : kReservedForSafe;
  }

  // A whole SET_MODE SAFE: nothing that the application refuses as damaged takes its place.
  static bool is_set_mode_safe(const CommandPacket& packet, bool has_trailer) {
    constexpr std::uint8_t kTelecommand = 0x18, kUnsegmented = 0xC0;
    constexpr std::size_t kSize = kCommandHeaderBytes + 1;
    const std::size_t size = kSize + (has_trailer ? kCommandTrailerBytes : 0);
    const std::uint8_t* const bytes = packet.bytes.data();
    return packet.size == size && (bytes[0] & 0xF8) == kTelecommand && (bytes[2] & 0xC0) == kUnsegmented &&
           bytes[4] == 0 && bytes[5] == size - kCommandPrimaryHeaderBytes - 1 &&
           bytes[kCommandFunctionOffset] == static_cast<std::uint8_t>(FunctionCode::kSetMode) &&
           bytes[kCommandHeaderBytes] == static_cast<std::uint8_t>(Mode::kSafe) &&
           command_checksum(bytes, size) == 0;
  }

  State vote() {
    std::array<std::array<std::uint8_t, sizeof(State)>, 3> bytes{};
    for (std::size_t copy = 0; copy < 3; ++copy)
      std::memcpy(bytes[copy].data(), &copies_[copy], sizeof(State));
    for (std::size_t i = 0; i < sizeof(State); ++i) {
      const std::uint8_t a = bytes[0][i], b = bytes[1][i], c = bytes[2][i];
      bytes[0][i] = static_cast<std::uint8_t>((a & b) | (c & (a | b)));
    }
    State state;
    std::memcpy(static_cast<void*>(&state), bytes[0].data(), sizeof(State));
    copies_.fill(state);
    return state;
  }

  std::array<State, 3> copies_{};
  DroppedCommands dropped_;
};

}  // namespace tumblesight::hal
