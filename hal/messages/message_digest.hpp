// Which fields of a message enter the digest of a run. Two runs with the same inputs have the same digest on
// every processor, at any speed and load. All fields do, except those that the wall clock or the platform
// decides.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/messages/fault.hpp"
#include "hal/messages/message_fields.hpp"

namespace tumblesight::hal {

// Faults that only the wall clock decides, as bits of Telemetry::faults_persisting.
inline constexpr std::uint32_t kTimingFaults =
    1U << static_cast<int>(Fault::kDeadline) | 1U << static_cast<int>(Fault::kSlip);

// The telemetry without what differs between two runs with the same inputs: this list is the only one.
inline Telemetry without_timing(Telemetry telemetry) {
  const Telemetry none;
  telemetry.faults_persisting &= ~kTimingFaults;
  // Events of timing faults are counted here, too, and wait in the same ring (depends_on_wall_clock()).
  telemetry.events = none.events;
  telemetry.events_suppressed = none.events_suppressed;
  telemetry.events_lost = none.events_lost;
  telemetry.events_waiting = none.events_waiting;
  telemetry.events_waiting_max = none.events_waiting_max;
  // Measured by the stopwatch.
  telemetry.inference_us = none.inference_us;
  telemetry.inference_max_us = none.inference_max_us;
  telemetry.cycle_us = none.cycle_us;
  telemetry.cycle_max_us = none.cycle_max_us;
  telemetry.store_us = none.store_us;
  telemetry.store_max_us = none.store_max_us;
  telemetry.cycles_by_time = none.cycles_by_time;
  telemetry.deadline_overruns = none.deadline_overruns;
  telemetry.registrations_cut_short = none.registrations_cut_short;
  telemetry.cycle_slips = none.cycle_slips;
  // Measured by the platform, where it can.
  telemetry.heap_allocations = none.heap_allocations;
  telemetry.stack_left_min_bytes = none.stack_left_min_bytes;
  return telemetry;
}

// Adds numbers to a CRC, each as 64 bits, little-endian. Crc: has add_u32(), as gnc::Crc32.
template <class Crc>
class NumberDigest {
 public:
  explicit NumberDigest(Crc& crc) : crc_(crc) {}

  template <class Number>
  void operator()(const Number& number) {
    const auto bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(number));
    crc_.add_u32(static_cast<std::uint32_t>(bits));
    crc_.add_u32(static_cast<std::uint32_t>(bits >> 32));
  }
  template <class Element, std::size_t kSize>
  void operator()(const std::array<Element, kSize>& numbers) {
    for (const Element& number : numbers) (*this)(number);
  }

 private:
  Crc& crc_;
};

template <class Crc>
void add_to_digest(Crc& crc, const AttitudeReport& report) {
  MessageFields<AttitudeReport>::visit(NumberDigest<Crc>(crc), report);
}
template <class Crc>
void add_to_digest(Crc& crc, const Telemetry& telemetry) {
  const Telemetry counted = without_timing(telemetry);
  MessageFields<Telemetry>::visit(NumberDigest<Crc>(crc), counted);
}
// Nothing of an event that depends on the wall clock.
template <class Crc>
void add_to_digest(Crc& crc, const Event& event) {
  if (!depends_on_wall_clock(event.id)) MessageFields<Event>::visit(NumberDigest<Crc>(crc), event);
}

}  // namespace tumblesight::hal
