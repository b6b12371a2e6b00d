#include "tests/support/stubs/zephyr/zephyr_stub.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

namespace tumblesight::test {
namespace {

char* slot_of(const k_msgq& queue, std::uint32_t index) {
  return queue.buffer + (queue.first + index) % queue.max_msgs * queue.msg_size;
}

void expire(k_timer& timer) {
  for (; timer.period_ticks > 0 && timer.next_ticks <= zephyr().uptime_ticks;
       timer.next_ticks += timer.period_ticks)
    ++timer.status;
}

}  // namespace

ZephyrStub& zephyr() {
  static ZephyrStub& stub = *new ZephyrStub;  // also for the destructors of a program's objects
  return stub;
}

}  // namespace tumblesight::test

using namespace tumblesight::test;

void k_msgq_init(k_msgq* queue, char* buffer, size_t msg_size, uint32_t max_msgs) {
  *queue = {buffer, msg_size, max_msgs, 0, 0};
}

int k_msgq_put(k_msgq* queue, const void* data, k_timeout_t timeout) {
  if (queue->used == queue->max_msgs) return timeout.ticks == 0 ? -ENOMSG : -EAGAIN;
  std::memcpy(slot_of(*queue, queue->used++), data, queue->msg_size);
  return 0;
}

int k_msgq_get(k_msgq* queue, void* data, k_timeout_t timeout) {
  if (queue->used == 0) return timeout.ticks == 0 ? -ENOMSG : -EAGAIN;
  std::memcpy(data, slot_of(*queue, 0), queue->msg_size);
  queue->first = (queue->first + 1) % queue->max_msgs;
  --queue->used;
  return 0;
}

uint32_t k_msgq_num_free_get(k_msgq* queue) {
  return queue->max_msgs - queue->used;
}

void k_timer_init(k_timer* timer, k_timer_expiry_t, k_timer_stop_t) {
  *timer = {};
}

void k_timer_start(k_timer* timer, k_timeout_t duration, k_timeout_t period) {
  *timer = {zephyr().uptime_ticks + duration.ticks, period.ticks, 0};
}

void k_timer_stop(k_timer* timer) {
  timer->period_ticks = 0;
}

uint32_t k_timer_status_get(k_timer* timer) {
  expire(*timer);
  return std::exchange(timer->status, 0U);
}

uint32_t k_timer_status_sync(k_timer* timer) {
  expire(*timer);
  if (timer->status == 0 && timer->period_ticks > 0) {
    zephyr().uptime_ticks = timer->next_ticks;
    if (zephyr().on_release && !zephyr().on_release(zephyr().uptime_ticks)) k_timer_stop(timer);
    timer->next_ticks = zephyr().uptime_ticks;
    expire(*timer);
  }
  return std::exchange(timer->status, 0U);
}

int64_t k_uptime_ticks(void) {
  return zephyr().uptime_ticks;
}

uint64_t k_ticks_to_ns_floor64(uint64_t ticks) {
  return ticks * STUB_NS_PER_TICK;
}
