#include "hal/dds/idl/domain.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>

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
    <LeaseDuration>%s</LeaseDuration>
    <SPDPInterval>500ms</SPDPInterval>
  </Discovery>
  <Internal><WriterLingerDuration>100ms</WriterLingerDuration></Internal>
)";
constexpr const char* kConfigurationEnd = "</Domain></CycloneDDS>";
constexpr std::size_t kMaxConfiguration = 2048;  // without the further elements

}  // namespace

// Linux lets a program bind to 127.0.0.1 even while the interface is down.
bool has_loopback() {
  ifaddrs* interfaces = nullptr;
  if (getifaddrs(&interfaces) != 0) return true;  // not known to be missing
  bool found = false;
  for (const ifaddrs* at = interfaces; at != nullptr && !found; at = at->ifa_next) {
    if (at->ifa_addr == nullptr || at->ifa_addr->sa_family != AF_INET || (at->ifa_flags & IFF_UP) == 0)
      continue;
    found = reinterpret_cast<const sockaddr_in*>(at->ifa_addr)->sin_addr.s_addr == htonl(INADDR_LOOPBACK);
  }
  freeifaddrs(interfaces);
  return found;
}

bool read_security(const char* path, SecurityElement& security) {
  // Non-blocking, so that a named pipe in its place does not block the start-up.
  const int file = ::open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return false;
  struct stat found {};
  const bool fits = fstat(file, &found) == 0 && S_ISREG(found.st_mode) && found.st_size > 0 &&
                    found.st_size < static_cast<off_t>(sizeof security.text);
  const auto size = static_cast<std::size_t>(fits ? found.st_size : 0);
  const bool complete = fits && ::read(file, security.text, size) == static_cast<ssize_t>(size);
  (void)::close(file);
  if (complete) security.text[size] = '\0';
  return complete;
}

const char* text_of_failure(dds_return_t code) {
  if (has_loopback()) return dds_strretcode(code);
  return "the loopback interface lo is down, or has no address 127.0.0.1; as root: ip link set lo up";
}

dds_return_t Domain::open(std::uint32_t id, const char* partition, const char* further, const char* lease) {
  close();
  id_ = id;
  partition_ = partition;
  char configuration[kMaxConfiguration + sizeof(SecurityElement)];
  const int begin = std::snprintf(configuration, kMaxConfiguration, kConfiguration, lease);
  if (begin < 0 || static_cast<std::size_t>(begin) >= kMaxConfiguration) return DDS_RETCODE_BAD_PARAMETER;
  const std::size_t left = sizeof configuration - static_cast<std::size_t>(begin);
  const int length = std::snprintf(configuration + begin, left, "%s%s", further, kConfigurationEnd);
  if (length < 0 || static_cast<std::size_t>(length) >= left) return DDS_RETCODE_BAD_PARAMETER;
  domain_ = dds_create_domain(id, configuration);
  if (domain_ < 0) return domain_;
  participant_ = dds_create_participant(id, nullptr, nullptr);
  return participant_ < 0 ? participant_ : 0;
}

dds_entity_t Domain::join() const {
  return dds_create_participant(id_, nullptr, nullptr);
}

void Domain::close() {
  if (domain_ > 0) dds_delete(domain_);
  domain_ = participant_ = 0;
}

}  // namespace tumblesight::hal::dds
