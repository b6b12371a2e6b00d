// The systems that tests of the common parts run on, each with a stub of its calls.
#pragma once

#include <gtest/gtest.h>

#include "hal/rtos/rtems/rtems_queue.hpp"
#include "hal/rtos/zephyr/zephyr_queue.hpp"
#include "tests/support/stubs/rtems/rtems_stub.hpp"
#include "tests/support/stubs/zephyr/zephyr_stub.hpp"

namespace tumblesight::hal::rtos {

struct Rtems {
  template <class T, std::size_t kDepth>
  using Queue = RtemsQueue<T, kDepth>;
};
struct Zephyr {
  template <class T, std::size_t kDepth>
  using Queue = ZephyrQueue<T, kDepth>;
};

using Systems = ::testing::Types<Rtems, Zephyr>;

}  // namespace tumblesight::hal::rtos
