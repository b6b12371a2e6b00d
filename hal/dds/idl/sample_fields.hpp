// Copies messages to and from the samples of the topics, field by field. The lists of fields are generated
// from tumblesight.idl, so a field of the IDL that the message lacks does not compile, and a field of the
// message that the IDL lacks fails the test Icd.MessagesAreTheTopics.
//
//   copy_attitude_fields(from, to)    hal::AttitudeReport, AttitudeSample
//   copy_telemetry_fields(from, to)   hal::Telemetry, TelemetrySample
//   copy_event_fields(from, to)       hal::Event, EventSample
//   copy_model_dump_fields(from, to)  hal::ModelDump, ModelDumpSample
//
// Each works in both directions. run_id and k, which only the samples have, are left to the caller.
#pragma once

#include <cstddef>
#include <iterator>
#include <type_traits>

namespace tumblesight::hal::dds {

// A number, an enumerator, or an array of these; both sides must have the same size.
template <class From, class To>
void copy_field(const From& from, To& to) {
  if constexpr (std::is_arithmetic_v<From> || std::is_enum_v<From>) {
    static_assert(sizeof(From) == sizeof(To), "the IDL and the message differ in a field's type");
    to = static_cast<To>(from);
  } else {
    static_assert(sizeof(From) == sizeof(To), "the IDL and the message differ in an array's size");
    for (std::size_t i = 0; i < std::size(from); ++i) copy_field(from[i], to[i]);
  }
}

#include "hal/dds/idl/sample_fields.inc"

}  // namespace tumblesight::hal::dds
