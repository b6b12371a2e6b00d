#include "hal/dds/idl/domain.hpp"

namespace tumblesight::hal::dds {
namespace {

// One LiDAR frame (33 KB) fits into one datagram. Without multicast, peers are found at the ports of the
// participant indices 0 to 32 on 127.0.0.1. A writer does not linger for a killed reader; callers that need
// the last samples delivered wait for their acknowledgment.
constexpr const char* kConfiguration = R"(
<CycloneDDS><Domain id="any">
  <General>
    <Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces>
    <AllowMulticast>false</AllowMulticast>
    <MaxMessageSize>65500B</MaxMessageSize>
    <FragmentSize>65000B</FragmentSize>
  </General>
  <Discovery>
    <ParticipantIndex>auto</ParticipantIndex>
    <MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
    <Peers><Peer address="127.0.0.1"/></Peers>
    <LeaseDuration>3s</LeaseDuration>
    <SPDPInterval>500ms</SPDPInterval>
  </Discovery>
  <Internal><WriterLingerDuration>100ms</WriterLingerDuration></Internal>
</Domain></CycloneDDS>)";

}  // namespace

dds_return_t Domain::open(std::uint32_t id, const char* partition) {
  partition_ = partition;
  domain_ = dds_create_domain(id, kConfiguration);
  if (domain_ < 0) return domain_;
  participant_ = dds_create_participant(id, nullptr, nullptr);
  return participant_ < 0 ? participant_ : 0;
}

void Domain::close() {
  if (domain_ > 0) dds_delete(domain_);
  domain_ = participant_ = 0;
}

}  // namespace tumblesight::hal::dds
