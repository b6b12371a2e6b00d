#include "hal/dds/flight_endpoints.hpp"

#include <initializer_list>

namespace tumblesight::hal::dds {

dds_return_t FlightEndpoints::open(dds_entity_t participant) {
  waitset_ = dds_create_waitset(participant);
  if (waitset_ < 0) return waitset_;
  dds_return_t result = hello_in.open(participant);
  if (result == 0) result = frames.open(participant);
  if (result == 0) result = commands.open(participant);
  if (result == 0) result = steps.open(participant);
  if (result == 0) result = hello_out.open(participant);
  if (result == 0) result = attitudes.open(participant);
  if (result == 0) result = telemetries.open(participant);
  if (result == 0) result = events.open(participant);
  if (result == 0) result = dumps.open(participant);
  if (result == 0) result = steps_done.open(participant);
  for (const dds_entity_t reader : {frames.entity(), commands.entity(), steps.entity()}) {
    if (result == 0) result = wake_on(reader);
  }
  return result;
}

dds_return_t FlightEndpoints::wake_on(dds_entity_t reader) const {
  const dds_entity_t condition = dds_create_readcondition(reader, DDS_ANY_STATE);
  return condition < 0 ? condition : dds_waitset_attach(waitset_, condition, 0);
}

bool FlightEndpoints::all_matched() const {
  return hello_in.matched() > 0 && frames.matched() > 0 && commands.matched() > 0 && steps.matched() > 0 &&
         hello_out.matched() > 0 && attitudes.matched() > 0 && telemetries.matched() > 0 &&
         events.matched() > 0 && dumps.matched() > 0 && steps_done.matched() > 0;
}

void FlightEndpoints::wait_for_data(std::int64_t timeout_ns) const {
  dds_attach_t trigger = 0;
  (void)dds_waitset_wait(waitset_, &trigger, 1, timeout_ns);
}

}  // namespace tumblesight::hal::dds
