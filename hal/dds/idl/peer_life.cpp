#include "hal/dds/idl/peer_life.hpp"

#include <cstdio>

namespace tumblesight::hal::dds {
namespace {

struct NameText {
  char text[MachineName::kMaxLength + 1];
};
// A process is one side of a run in a domain.
NameText name_of(std::uint32_t domain, const HelloSample& hello) {
  NameText name;
  std::snprintf(name.text, sizeof name.text, "tumblesight-life-%u-%u-%u", static_cast<unsigned>(domain),
                static_cast<unsigned>(hello.role), static_cast<unsigned>(hello.process_id));
  return name;
}

}  // namespace

void PeerLife::show(std::uint32_t domain, const HelloSample& ours) {
  if (name_.hold(name_of(domain, ours).text) == 0) (void)name_.let_watch();
}

void PeerLife::watch(std::uint32_t domain, const HelloSample& theirs) {
  (void)watch_.start(name_of(domain, theirs).text);
}

}  // namespace tumblesight::hal::dds
