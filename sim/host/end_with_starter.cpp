#include "sim/host/end_with_starter.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace tumblesight::sim {
namespace {

// Process 1 may be the starter: in a container.
bool starter_has_ended(pid_t parent_before) {
  const char* starter = std::getenv(kStarterVariable);
  return starter != nullptr ? std::to_string(getppid()) != starter : getppid() != parent_before;
}

}  // namespace

std::string starter_environment() {
  return std::string(kStarterVariable) + "=" + std::to_string(getpid());
}

void end_with_starter() {
  const pid_t parent = getppid();
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  // Nothing is sent for a parent that ended before.
  if (!starter_has_ended(parent)) return;
  std::fputs("tumblesight: the process that started this one has ended, so this one ends, too\n", stderr);
  kill(getpid(), SIGTERM);
}

}  // namespace tumblesight::sim
