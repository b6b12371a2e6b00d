/* The calls of RTEMS 6 that hal/rtos/rtems and fsw/programs/rtos/rtems use, with names, types and values of
 * the Classic API. rtems_stub.hpp: how a test controls them. */
#ifndef RTEMS_H
#define RTEMS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef uint32_t rtems_attribute;
typedef uint32_t rtems_id;
typedef uint32_t rtems_interval;
typedef uint32_t rtems_name;
typedef uint32_t rtems_option;
typedef uintptr_t rtems_task_argument;
typedef void rtems_task;

typedef enum {
  RTEMS_SUCCESSFUL = 0,
  RTEMS_INVALID_ID = 4,
  RTEMS_TOO_MANY = 5,
  RTEMS_TIMEOUT = 6,
  RTEMS_INVALID_SIZE = 8,
  RTEMS_UNSATISFIED = 13
} rtems_status_code;

#define RTEMS_DEFAULT_ATTRIBUTES 0
#define RTEMS_DEFAULT_MODES 0
#define RTEMS_FLOATING_POINT 1
#define RTEMS_NO_WAIT 1
#define RTEMS_NO_TIMEOUT 0

#define rtems_build_name(a, b, c, d) \
  ((uint32_t)(a) << 24 | (uint32_t)(b) << 16 | (uint32_t)(c) << 8 | (uint32_t)(d))

/* What the kernel keeps beside a message. */
typedef struct {
  void* node[2];
  size_t size;
} CORE_message_queue_Buffer;

#define RTEMS_MESSAGE_QUEUE_BUFFER(bytes) \
  struct {                                \
    CORE_message_queue_Buffer buffer;     \
    char message[bytes];                  \
  }

typedef struct {
  rtems_name name;
  uint32_t maximum_pending_messages;
  size_t maximum_message_size;
  void* storage_area;
  size_t storage_size;
  void (*storage_free)(void*);
  rtems_attribute attributes;
} rtems_message_queue_config;

rtems_status_code rtems_message_queue_construct(const rtems_message_queue_config* config, rtems_id* id);
rtems_status_code rtems_message_queue_send(rtems_id id, const void* buffer, size_t size);
rtems_status_code rtems_message_queue_receive(rtems_id id, void* buffer, size_t* size, rtems_option options,
                                              rtems_interval timeout);
rtems_status_code rtems_message_queue_get_number_pending(rtems_id id, uint32_t* count);

typedef struct {
  uint32_t postponed_jobs_count; /* and others, which the port does not read */
} rtems_rate_monotonic_period_status;

rtems_status_code rtems_rate_monotonic_create(rtems_name name, rtems_id* id);
rtems_status_code rtems_rate_monotonic_period(rtems_id id, rtems_interval length);
rtems_status_code rtems_rate_monotonic_get_status(rtems_id id, rtems_rate_monotonic_period_status* status);
rtems_status_code rtems_rate_monotonic_delete(rtems_id id);

uint32_t rtems_configuration_get_microseconds_per_tick(void);
uint64_t rtems_clock_get_uptime_nanoseconds(void);
void rtems_task_exit(void);

#ifdef __cplusplus
}
#endif

#endif /* RTEMS_H */
