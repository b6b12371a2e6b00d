// The fields of the messages that the application publishes, for code that treats all fields alike: copies,
// packets, printing. The lists are generated from the structures, so a new field needs no row here.
//
//   MessageFields<Message>::visit(visitor, a, b, ...)  calls visitor(a.field, b.field, ...) for each field in
//                                                      the order of the structure. The arguments are messages
//                                                      or types with fields of the same names.
//   MessageFields<Message>::kNames                     the names, in the same order
//
// Message: AttitudeReport, Telemetry, Event, MemoryDump.
#pragma once

#include "hal/messages/attitude_report.hpp"
#include "hal/messages/event.hpp"
#include "hal/messages/memory_dump.hpp"
#include "hal/messages/telemetry.hpp"

namespace tumblesight::hal {

template <class Message>
struct MessageFields;

#include "hal/messages/message_fields.inc"

}  // namespace tumblesight::hal
