// The initialization task of RTEMS, which becomes the flight task, and the configuration. Compile it with
// your board's sources and link tumblesight::fsw_app and tumblesight::hal_packets.
#include <rtems.h>

#include "fsw/programs/rtos/rtems/flight.hpp"

namespace {

using namespace tumblesight::fsw::rtos;

RtemsFlight flight;

const char* fly(const Board& board) {
  if (!flight.start(board)) return "RTEMS has too few message queues: CONFIGURE_MAXIMUM_MESSAGE_QUEUES";
  start_drivers(flight);
  flight.run(board);
  return "RTEMS refused the rate-monotonic period";
}

}  // namespace

// After the task has ended, the watchdog resets the processor.
rtems_task Init(rtems_task_argument) {
  const Board the_board = board();
  the_board.log(fly(the_board));
  rtems_task_exit();
}

// A period of 2.7 s has to be a multiple of the tick.
#define CONFIGURE_MICROSECONDS_PER_TICK 10000
#define CONFIGURE_APPLICATION_NEEDS_CLOCK_DRIVER
#define CONFIGURE_MAXIMUM_TASKS 4
#define CONFIGURE_MAXIMUM_MESSAGE_QUEUES 7
#define CONFIGURE_MAXIMUM_PERIODS 1
#define CONFIGURE_RTEMS_INIT_TASKS_TABLE
// Less urgent than the tasks of sensor and radio: a step takes up to half a period.
#define CONFIGURE_INIT_TASK_PRIORITY 100
#define CONFIGURE_INIT_TASK_INITIAL_MODES RTEMS_DEFAULT_MODES  // otherwise they could not preempt it
#define CONFIGURE_INIT_TASK_STACK_SIZE (16 * 1024)
#define CONFIGURE_INIT_TASK_ATTRIBUTES RTEMS_FLOATING_POINT
#define CONFIGURE_INIT
#include <rtems/confdefs.h>
