#include "sim/sil/simulator_endpoints.hpp"

#include <initializer_list>
#include <string>

#include "sim/sil/failure.hpp"

namespace tumblesight::sim {
namespace {

void check(dds_return_t result) {
  if (result < 0) throw SilFailure(std::string("DDS could not be set up: ") + dds_strretcode(result));
}

}  // namespace

SimulatorEndpoints::SimulatorEndpoints(const hal::dds::Domain& domain) {
  check(hello_out.open(domain));
  check(frames.open(domain));
  check(navigations.open(domain));
  check(commands.open(domain));
  check(steps.open(domain));
  check(truth.open(domain));
  check(hello_in.open(domain));
  check(attitudes.open(domain));
  check(telemetries.open(domain));
  check(events.open(domain));
  check(dumps.open(domain));
  check(steps_done.open(domain));
  waitset_ = dds_create_waitset(domain.participant());
  check(waitset_);
  for (const dds_entity_t reader :
       {attitudes.entity(), telemetries.entity(), events.entity(), dumps.entity(), steps_done.entity()}) {
    const dds_entity_t condition = dds_create_readcondition(reader, DDS_ANY_STATE);
    check(condition);
    check(dds_waitset_attach(waitset_, condition, 0));
  }
}

bool SimulatorEndpoints::bind(const hal::dds::PeerKey& flight) {
  const bool readers = hello_in.bind(flight) && attitudes.bind(flight) && telemetries.bind(flight) &&
                       events.bind(flight) && dumps.bind(flight) && steps_done.bind(flight);
  return readers && hello_out.has_reader_of(flight) && frames.has_reader_of(flight) &&
         navigations.has_reader_of(flight) && commands.has_reader_of(flight) && steps.has_reader_of(flight);
}

hal::dds::Foreigner SimulatorEndpoints::foreigner() const {
  for (const hal::dds::BoundReader* reader : std::initializer_list<const hal::dds::BoundReader*>{
           &steps_done, &attitudes, &telemetries, &events, &dumps, &hello_in}) {
    const hal::dds::Foreigner foreigner = reader->foreigner();
    if (foreigner) return foreigner;
  }
  return {};
}

bool SimulatorEndpoints::wait_for_data(std::int64_t timeout_ns) {
  dds_attach_t trigger = 0;
  return dds_waitset_wait(waitset_, &trigger, 1, timeout_ns) > 0;
}

}  // namespace tumblesight::sim
