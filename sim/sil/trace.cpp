#include "sim/sil/trace.hpp"

#include "hal/messages/message_digest.hpp"

namespace tumblesight::sim {

void TraceDigest::add(std::uint32_t k, const StepResult& step) {
  hal::NumberDigest numbers(crc_);
  numbers(k);
  numbers(step.time_ns);
  hal::add_to_digest(crc_, step.attitude);
  hal::add_to_digest(crc_, step.telemetry);
  for (const hal::Event& event : step.events) hal::add_to_digest(crc_, event);
  numbers(step.state_crc32);
}

}  // namespace tumblesight::sim
