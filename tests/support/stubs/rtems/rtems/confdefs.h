/* The configuration of an RTEMS program out of its CONFIGURE_ macros: here, the limits for the stub. */
#ifndef RTEMS_CONFDEFS_H
#define RTEMS_CONFDEFS_H

#if !defined(CONFIGURE_APPLICATION_NEEDS_CLOCK_DRIVER) || !defined(CONFIGURE_RTEMS_INIT_TASKS_TABLE) || \
    !defined(CONFIGURE_MAXIMUM_TASKS)
#error "a program needs tasks, an initialization task and a clock"
#endif

/* Its default is that nothing preempts the initialization task. */
#if !defined(CONFIGURE_INIT_TASK_INITIAL_MODES) || CONFIGURE_INIT_TASK_INITIAL_MODES != RTEMS_DEFAULT_MODES
#error "the flight task keeps the tasks of sensor and radio from running"
#endif

#ifdef CONFIGURE_INIT
#include "tests/support/stubs/rtems/rtems_stub.hpp"
const tumblesight::test::RtemsLimits rtems_configured = {
    CONFIGURE_MAXIMUM_MESSAGE_QUEUES, CONFIGURE_MAXIMUM_PERIODS, CONFIGURE_MICROSECONDS_PER_TICK};
#endif

#endif /* RTEMS_CONFDEFS_H */
