// PeerLife: how each side of a run notices that the other one was killed. DDS would report it only after the
// lease of the other participant, which is long so that a pause does not end a run (Domain). So each side
// holds a name of the machine (MachineName), announces it in its hello, and watches the name of the other
// side. Where that is not possible, as between two users, the time limits of the wait for the other side
// apply.
#pragma once

#include <cstdint>

#include "hal/dds/idl/machine_name.hpp"
#include "hal/dds/idl/topics.hpp"

namespace tumblesight::hal::dds {

class PeerLife {
 public:
  // From now on the other side can watch this process. Before its hello is written.
  void show(std::uint32_t domain, const HelloSample& ours);
  void watch(std::uint32_t domain, const HelloSample& theirs);
  void forget() { watch_.stop(); }
  bool peer_ended() const { return watch_.holder_ended(); }

 private:
  MachineName name_;
  NameWatch watch_;
};

}  // namespace tumblesight::hal::dds
