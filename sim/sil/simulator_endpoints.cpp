#include "sim/sil/simulator_endpoints.hpp"

#include <string>

#include "sim/sil/failure.hpp"

namespace tumblesight::sim {
namespace {

void check(dds_return_t result) {
  if (result < 0) throw SilFailure(std::string("DDS could not be set up: ") + dds_strretcode(result));
}

}  // namespace

SimulatorEndpoints::SimulatorEndpoints(dds_entity_t participant) {
  check(hello_out.open(participant));
  check(frames.open(participant));
  check(commands.open(participant));
  check(steps.open(participant));
  check(truth.open(participant));
  check(hello_in.open(participant));
  check(attitudes.open(participant));
  check(telemetries.open(participant));
  check(events.open(participant));
  check(dumps.open(participant));
  check(steps_done.open(participant));
  waitset_ = dds_create_waitset(participant);
  check(waitset_);
  for (const dds_entity_t reader :
       {attitudes.entity(), telemetries.entity(), events.entity(), dumps.entity(), steps_done.entity()}) {
    const dds_entity_t condition = dds_create_readcondition(reader, DDS_ANY_STATE);
    check(condition);
    check(dds_waitset_attach(waitset_, condition, 0));
  }
}

bool SimulatorEndpoints::all_matched() const {
  return hello_out.matched() > 0 && frames.matched() > 0 && commands.matched() > 0 && steps.matched() > 0 &&
         hello_in.matched() > 0 && attitudes.matched() > 0 && telemetries.matched() > 0 &&
         events.matched() > 0 && dumps.matched() > 0 && steps_done.matched() > 0;
}

bool SimulatorEndpoints::wait_for_data(std::int64_t timeout_ns) {
  dds_attach_t trigger = 0;
  return dds_waitset_wait(waitset_, &trigger, 1, timeout_ns) > 0;
}

}  // namespace tumblesight::sim
