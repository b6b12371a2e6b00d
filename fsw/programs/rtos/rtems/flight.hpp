// The flight program on RTEMS 6.
#pragma once

#include "fsw/programs/rtos/flight.hpp"
#include "hal/rtos/rtems/rtems_periodic_task.hpp"
#include "hal/rtos/rtems/rtems_queue.hpp"

namespace tumblesight::fsw::rtos {

using RtemsFlight = Flight<hal::rtos::RtemsPeriodicTask, hal::rtos::RtemsStopwatch, hal::rtos::RtemsQueue>;

// Yours: creates the tasks of sensor and radio. CONFIGURE_MAXIMUM_TASKS in init.cpp counts them.
void start_drivers(RtemsFlight& flight);

}  // namespace tumblesight::fsw::rtos

extern "C" rtems_task Init(rtems_task_argument);
