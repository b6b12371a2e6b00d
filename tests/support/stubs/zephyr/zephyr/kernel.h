/* The calls of Zephyr that hal/rtos/zephyr and fsw/programs/rtos/zephyr use. zephyr_stub.hpp: how a test
 * controls them. */
#ifndef ZEPHYR_KERNEL_H
#define ZEPHYR_KERNEL_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  int64_t ticks;
} k_timeout_t;

static inline k_timeout_t stub_timeout(int64_t ticks) {
  const k_timeout_t timeout = {ticks};
  return timeout;
}

#define CONFIG_SYS_CLOCK_TICKS_PER_SEC 10000
#define STUB_NS_PER_TICK (1000000000 / CONFIG_SYS_CLOCK_TICKS_PER_SEC)
#define K_NO_WAIT stub_timeout(0)
#define K_NSEC(ns) stub_timeout(((ns) + STUB_NS_PER_TICK - 1) / STUB_NS_PER_TICK)

struct k_msgq {
  char* buffer;
  size_t msg_size;
  uint32_t max_msgs;
  uint32_t first;
  uint32_t used;
};

void k_msgq_init(struct k_msgq* queue, char* buffer, size_t msg_size, uint32_t max_msgs);
int k_msgq_put(struct k_msgq* queue, const void* data, k_timeout_t timeout);
int k_msgq_get(struct k_msgq* queue, void* data, k_timeout_t timeout);
uint32_t k_msgq_num_free_get(struct k_msgq* queue);

struct k_timer {
  int64_t next_ticks;
  int64_t period_ticks; /* 0: stopped */
  uint32_t status;
};
typedef void (*k_timer_expiry_t)(struct k_timer*);
typedef void (*k_timer_stop_t)(struct k_timer*);

void k_timer_init(struct k_timer* timer, k_timer_expiry_t expiry, k_timer_stop_t stop);
void k_timer_start(struct k_timer* timer, k_timeout_t duration, k_timeout_t period);
void k_timer_stop(struct k_timer* timer);
uint32_t k_timer_status_get(struct k_timer* timer);
uint32_t k_timer_status_sync(struct k_timer* timer);

int64_t k_uptime_ticks(void);
uint64_t k_ticks_to_ns_floor64(uint64_t ticks);

#ifdef __cplusplus
}
#endif

#endif /* ZEPHYR_KERNEL_H */
