// Messages as lines of JSON, with the names and values of all fields: what another reader of the same message
// has to find.
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <type_traits>

#include "hal/messages/message_fields.hpp"

namespace tumblesight::test {

template <class Field>
void print_value(std::ostream& out, const Field& field) {
  if constexpr (std::is_enum_v<Field>) {
    print_value(out, static_cast<std::underlying_type_t<Field>>(field));
  } else if constexpr (std::is_integral_v<Field>) {
    out << +field;
  } else {
    const char* separator = "";
    out << "[";
    for (const auto& element : field) {
      out << separator;
      print_value(out, element);
      separator = ", ";
    }
    out << "]";
  }
}

// {"packet": name, "fields": {...}} and the end of the line.
template <class Message>
void print_message(std::ostream& out, const std::string& name, const Message& message) {
  const char* const* field_name = hal::MessageFields<Message>::kNames;
  const char* separator = "";
  out << "{\"packet\": \"" << name << "\", \"fields\": {";
  hal::MessageFields<Message>::visit(
      [&](const auto& field) {
        out << separator << "\"" << *field_name++ << "\": ";
        print_value(out, field);
        separator = ", ";
      },
      message);
  out << "}}\n";
}

inline void print(std::ostream& out, const hal::AttitudeReport& message) {
  print_message(out, "AttitudeReport", message);
}
inline void print(std::ostream& out, const hal::Telemetry& message) {
  print_message(out, "Telemetry", message);
}
inline void print(std::ostream& out, const hal::Event& message) {
  print_message(out, "Event", message);
}
inline void print(std::ostream& out, const hal::MemoryDump& message) {
  print_message(out, "MemoryDump", message);
}

}  // namespace tumblesight::test
