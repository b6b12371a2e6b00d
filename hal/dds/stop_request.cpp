#include "hal/dds/stop_request.hpp"

#include <atomic>
#include <csignal>

namespace tumblesight::hal::dds {
namespace {

// Written by whichever thread receives the signal, read by the bus thread.
std::atomic<int> requested{0};  // the signal
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler must not lock");

void request_stop(int signal) {
  requested = signal;
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
  return requested != 0;
}

FlightEnd stop_reason() {
  return requested == SIGINT ? FlightEnd::kInterrupted : FlightEnd::kTerminated;
}

}  // namespace tumblesight::hal::dds
