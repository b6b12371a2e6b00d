#include "hal/posix/monitored_stack.hpp"

#include <algorithm>

namespace tumblesight::hal::posix {

bool MonitoredStack::start(pthread_t& thread, void* (*main)(void*), void* argument) {
  pthread_attr_t attributes;
  if (pthread_attr_init(&attributes) != 0) return false;
  const bool started = pthread_attr_setstack(&attributes, words_.data(), kBytes) == 0 &&
                       pthread_create(&thread, &attributes, main, argument) == 0;
  (void)pthread_attr_destroy(&attributes);
  return started;
}

// The stack grows towards lower addresses on every supported Linux processor.
std::uint32_t MonitoredStack::least_left_bytes() const {
  const auto used =
      std::find_if(words_.begin(), words_.end(), [](std::uint64_t word) { return word != kPattern; });
  return static_cast<std::uint32_t>(static_cast<std::size_t>(used - words_.begin()) * sizeof(std::uint64_t));
}

}  // namespace tumblesight::hal::posix
