// Domain: a process's place on the bus. Loopback only, so that nothing leaves the machine, with discovery by
// unicast (works where multicast does not) and a short lease, so that a killed peer is noticed within a few
// seconds.
#pragma once

#include <dds/dds.h>

#include <cstdint>

namespace tumblesight::hal::dds {

inline constexpr std::uint32_t kMaxDomain = 230;  // above it the UDP ports of DDS end

class Domain {
 public:
  Domain() = default;
  ~Domain() { close(); }
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;

  // 0, or a negative DDS return code (dds_strretcode() says it in words).
  [[nodiscard]] dds_return_t open(std::uint32_t id);
  // Ends every reader and writer in it.
  void close();
  dds_entity_t participant() const { return participant_; }

 private:
  dds_entity_t domain_ = 0;
  dds_entity_t participant_ = 0;
};

}  // namespace tumblesight::hal::dds
