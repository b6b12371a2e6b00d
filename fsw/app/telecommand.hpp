// Telecommand: the part of a telecommand packet that its handler reads.
#pragma once

#include <cstdint>

#include "hal/messages/command_packet.hpp"
#include "hal/messages/command_refusal.hpp"
#include "hal/messages/function_code.hpp"

namespace tumblesight::fsw {

using hal::CommandRefusal;
using hal::FunctionCode;

struct Telecommand {
  FunctionCode function = FunctionCode::kNoop;
  const std::uint8_t* arguments = nullptr;  // points into the packet
  int argument_bytes = 0;                   // within the range of the command table

  // Big-endian. The field must lie within the arguments.
  std::uint8_t u8_at(int offset) const { return arguments[offset]; }
  std::uint16_t u16_at(int offset) const {
    return static_cast<std::uint16_t>(arguments[offset] << 8 | arguments[offset + 1]);
  }
  std::uint32_t u32_at(int offset) const { return std::uint32_t{u16_at(offset)} << 16 | u16_at(offset + 2); }
};

}  // namespace tumblesight::fsw
