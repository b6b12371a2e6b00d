// What a flight program on a real-time operating system needs of your board. Define board() and, for the
// system, start_drivers() (rtems/flight.hpp, zephyr/flight.hpp).
#pragma once

#include "hal/navigation.hpp"
#include "hal/platform.hpp"
#include "hal/watchdog.hpp"

namespace tumblesight::fsw::rtos {

struct Board {
  // The model images, and as far as you have them: command keys, a persistent store, the cause of the reset.
  // The stopwatch is the system's.
  hal::Platform platform;
  hal::Watchdog* watchdog = nullptr;        // required
  hal::Navigation* navigation = nullptr;    // nullptr: the chaser's attitude is not known
  const char* target = nullptr;             // refuse the model of another one; nullptr: any
  void (*log)(const char* text) = nullptr;  // required: why the program ended
};

Board board();

}  // namespace tumblesight::fsw::rtos
