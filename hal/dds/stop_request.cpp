#include "hal/dds/stop_request.hpp"

#include <csignal>

namespace tumblesight::hal::dds {
namespace {

volatile std::sig_atomic_t requested = 0;

void request_stop(int) {
  requested = 1;
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

}  // namespace tumblesight::hal::dds
