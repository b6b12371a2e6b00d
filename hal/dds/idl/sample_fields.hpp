// Copies messages to and from the samples of the topics, field by field. The fields are those of the message
// (hal/messages/message_fields.hpp), so a field of the message that the IDL lacks does not compile, and a
// field of the IDL that the message lacks fails the test Icd.MessagesAreTheTopics.
//
//   copy_attitude_fields(from, to)    hal::AttitudeReport, AttitudeSample
//   copy_telemetry_fields(from, to)   hal::Telemetry, TelemetrySample
//   copy_event_fields(from, to)       hal::Event, EventSample
//   copy_memory_dump_fields(from, to)  hal::MemoryDump, MemoryDumpSample
//
// Each works in both directions. run_id and k, which only the samples have, are left to the caller.
#pragma once

#include <cstddef>
#include <iterator>
#include <type_traits>

#include "hal/messages/message_fields.hpp"

namespace tumblesight::hal::dds {

// A number, an enumerator, or an array of these; both sides must have the same size.
struct CopyField {
  template <class From, class To>
  void operator()(const From& from, To& to) const {
    if constexpr (std::is_arithmetic_v<From> || std::is_enum_v<From>) {
      static_assert(sizeof(From) == sizeof(To), "the IDL and the message differ in a field's type");
      to = static_cast<To>(from);
    } else {
      static_assert(sizeof(From) == sizeof(To), "the IDL and the message differ in an array's size");
      for (std::size_t i = 0; i < std::size(from); ++i) (*this)(from[i], to[i]);
    }
  }
};

template <class From, class To>
void copy_attitude_fields(const From& from, To& to) {
  MessageFields<AttitudeReport>::visit(CopyField{}, from, to);
}
template <class From, class To>
void copy_telemetry_fields(const From& from, To& to) {
  MessageFields<Telemetry>::visit(CopyField{}, from, to);
}
template <class From, class To>
void copy_event_fields(const From& from, To& to) {
  MessageFields<Event>::visit(CopyField{}, from, to);
}
template <class From, class To>
void copy_memory_dump_fields(const From& from, To& to) {
  MessageFields<MemoryDump>::visit(CopyField{}, from, to);
}

}  // namespace tumblesight::hal::dds
