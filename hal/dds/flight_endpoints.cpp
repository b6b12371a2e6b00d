#include "hal/dds/flight_endpoints.hpp"

#include <initializer_list>

namespace tumblesight::hal::dds {

dds_return_t FlightEndpoints::open(const Domain& domain) {
  domain_ = domain.id();
  waitset_ = dds_create_waitset(domain.participant());
  if (waitset_ < 0) return waitset_;
  dds_return_t result = hello_in.open(domain);
  if (result == 0) result = frames.open(domain);
  if (result == 0) result = navigations.open(domain);
  if (result == 0) result = commands.open(domain);
  if (result == 0) result = steps.open(domain);
  if (result == 0) result = hello_out.open(domain);
  if (result == 0) result = attitudes.open(domain);
  if (result == 0) result = telemetries.open(domain);
  if (result == 0) result = events.open(domain);
  if (result == 0) result = dumps.open(domain);
  if (result == 0) result = steps_done.open(domain);
  for (const dds_entity_t reader :
       {frames.entity(), navigations.entity(), commands.entity(), steps.entity()}) {
    if (result == 0) result = wake_on(reader);
  }
  return result;
}

dds_return_t FlightEndpoints::wake_on(dds_entity_t reader) const {
  const dds_entity_t condition = dds_create_readcondition(reader, DDS_ANY_STATE);
  return condition < 0 ? condition : dds_waitset_attach(waitset_, condition, 0);
}

bool FlightEndpoints::bind(const PeerKey& simulator) {
  const bool readers = hello_in.bind(simulator) && frames.bind(simulator) && navigations.bind(simulator) &&
                       commands.bind(simulator) && steps.bind(simulator);
  return readers && hello_out.has_reader_of(simulator) && attitudes.has_reader_of(simulator) &&
         telemetries.has_reader_of(simulator) && events.has_reader_of(simulator) &&
         dumps.has_reader_of(simulator) && steps_done.has_reader_of(simulator);
}

Foreigner FlightEndpoints::foreigner() const {
  for (const BoundReader* reader :
       std::initializer_list<const BoundReader*>{&steps, &frames, &navigations, &commands, &hello_in}) {
    const Foreigner foreigner = reader->foreigner();
    if (foreigner) return foreigner;
  }
  return {};
}

void FlightEndpoints::wait_for_data(std::int64_t timeout_ns) const {
  dds_attach_t trigger = 0;
  (void)dds_waitset_wait(waitset_, &trigger, 1, timeout_ns);
}

}  // namespace tumblesight::hal::dds
