// read_packet<Message>(): the fields of a telemetry packet (docs/icd.md), read independently of the flight
// side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "hal/messages/message_fields.hpp"
#include "hal/packets/telemetry_encoder.hpp"

namespace tumblesight::test {

// Fields are big-endian and follow the headers without gaps.
class FieldReader {
 public:
  explicit FieldReader(const std::uint8_t* at) : at_(at) {}

  template <class Field>
  void operator()(Field& field) {
    if constexpr (std::is_integral_v<Field> || std::is_enum_v<Field>) {
      std::uint64_t bits = 0;
      for (std::size_t i = 0; i < sizeof(Field); ++i) bits = bits << 8 | *at_++;
      field = static_cast<Field>(bits);
    } else {
      for (auto& element : field) (*this)(element);
    }
  }

 private:
  const std::uint8_t* at_;
};

// A packet of another size gives a message of initial values.
template <class Message>
Message read_packet(const std::uint8_t* packet, std::size_t size) {
  Message message;
  if (size != hal::packets::packet_bytes<Message>()) return message;
  hal::MessageFields<Message>::visit(
      FieldReader(packet + hal::packets::kPrimaryHeaderBytes + hal::packets::kTimeBytes), message);
  return message;
}

}  // namespace tumblesight::test
