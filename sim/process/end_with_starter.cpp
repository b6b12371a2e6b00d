#include "sim/process/end_with_starter.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cstdlib>

namespace tumblesight::sim {
namespace {

constexpr char kStarter[] = "TUMBLESIGHT_STARTER";

bool starter_has_ended() {
  const char* starter = std::getenv(kStarter);
  return starter != nullptr ? std::to_string(getppid()) != starter : getppid() == 1;
}

}  // namespace

std::string starter_environment() {
  return std::string(kStarter) + "=" + std::to_string(getpid());
}

void end_with_starter() {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  // Nothing is sent for a parent that ended before.
  if (starter_has_ended()) kill(getpid(), SIGTERM);
}

}  // namespace tumblesight::sim
