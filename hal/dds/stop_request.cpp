#include "hal/dds/stop_request.hpp"

#include <atomic>
#include <csignal>

namespace tumblesight::hal::dds {
namespace {

// Written by whichever thread receives the signal, read by the bus thread.
std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");

void request_stop(int) {
  requested = true;
}

}  // namespace

void accept_stop_requests() {
  struct sigaction action {};
  action.sa_handler = request_stop;
  sigemptyset(&action.sa_mask);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
}

bool stop_requested() {
  return requested;
}

}  // namespace tumblesight::hal::dds
