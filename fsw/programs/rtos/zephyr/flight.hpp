// The flight program on Zephyr.
#pragma once

#include "fsw/programs/rtos/flight.hpp"
#include "hal/rtos/zephyr/zephyr_periodic_task.hpp"
#include "hal/rtos/zephyr/zephyr_queue.hpp"

namespace tumblesight::fsw::rtos {

using ZephyrFlight =
    Flight<hal::rtos::ZephyrPeriodicTask, hal::rtos::ZephyrStopwatch, hal::rtos::ZephyrQueue>;

// Yours: creates the threads of sensor and radio.
void start_drivers(ZephyrFlight& flight);

}  // namespace tumblesight::fsw::rtos
