#include "tests/support/stubs/rtems/rtems_stub.hpp"

#include <cstring>

namespace tumblesight::test {
namespace {

rtems_status_code refusal_of(const char* function) {
  const auto found = rtems().refusals.find(function);
  return found == rtems().refusals.end() ? RTEMS_SUCCESSFUL : found->second;
}

template <class Object>
Object* find(std::map<rtems_id, Object>& objects, rtems_id id) {
  const auto found = objects.find(id);
  return found == objects.end() ? nullptr : &found->second;
}

std::int64_t length_ns(rtems_interval ticks) {
  return std::int64_t{ticks} * rtems().limits.us_per_tick * 1000;
}

// Deadlines that have passed become jobs that wait.
void postpone(RtemsStub::Period& period, rtems_interval length) {
  for (; period.is_active && period.deadline_ns <= rtems().uptime_ns; period.deadline_ns += length_ns(length))
    ++period.postponed;
}

rtems_status_code wait_for_deadline(RtemsStub::Period& period, rtems_interval length) {
  rtems().uptime_ns = period.deadline_ns;
  const bool goes_on = !rtems().on_release || rtems().on_release(rtems().uptime_ns);
  period.deadline_ns = rtems().uptime_ns + length_ns(length);
  return goes_on ? RTEMS_SUCCESSFUL : RTEMS_INVALID_ID;
}

}  // namespace

RtemsStub& rtems() {
  static RtemsStub& stub = *new RtemsStub;  // also for the destructors of a program's objects
  return stub;
}

}  // namespace tumblesight::test

using namespace tumblesight::test;

rtems_status_code rtems_message_queue_construct(const rtems_message_queue_config* config, rtems_id* id) {
  if (const rtems_status_code refused = refusal_of(__func__)) return refused;
  if (rtems().queues.size() == rtems().limits.message_queues) return RTEMS_TOO_MANY;
  const std::size_t words = (config->maximum_message_size + sizeof(void*) - 1) / sizeof(void*);
  const std::size_t bytes = sizeof(CORE_message_queue_Buffer) + words * sizeof(void*);
  if (config->storage_area == nullptr || config->storage_size != config->maximum_pending_messages * bytes)
    return RTEMS_UNSATISFIED;
  *id = ++rtems().last_id;
  rtems().queues[*id] = {config->maximum_message_size, config->maximum_pending_messages, {}};
  return RTEMS_SUCCESSFUL;
}

rtems_status_code rtems_message_queue_send(rtems_id id, const void* buffer, size_t size) {
  if (const rtems_status_code refused = refusal_of(__func__)) return refused;
  RtemsStub::Queue* const queue = find(rtems().queues, id);
  if (queue == nullptr) return RTEMS_INVALID_ID;
  if (size > queue->message_size) return RTEMS_INVALID_SIZE;
  if (queue->messages.size() == queue->depth) return RTEMS_TOO_MANY;
  const char* const bytes = static_cast<const char*>(buffer);
  queue->messages.emplace_back(bytes, bytes + size);
  return RTEMS_SUCCESSFUL;
}

rtems_status_code rtems_message_queue_receive(rtems_id id, void* buffer, size_t* size, rtems_option options,
                                              rtems_interval) {
  if (const rtems_status_code refused = refusal_of(__func__)) return refused;
  RtemsStub::Queue* const queue = find(rtems().queues, id);
  if (queue == nullptr) return RTEMS_INVALID_ID;
  if (queue->messages.empty()) return options == RTEMS_NO_WAIT ? RTEMS_UNSATISFIED : RTEMS_TIMEOUT;
  *size = queue->messages.front().size();
  std::memcpy(buffer, queue->messages.front().data(), *size);
  queue->messages.pop_front();
  return RTEMS_SUCCESSFUL;
}

rtems_status_code rtems_message_queue_get_number_pending(rtems_id id, uint32_t* count) {
  if (const rtems_status_code refused = refusal_of(__func__)) return refused;
  RtemsStub::Queue* const queue = find(rtems().queues, id);
  if (queue == nullptr) return RTEMS_INVALID_ID;
  *count = static_cast<uint32_t>(queue->messages.size());
  return RTEMS_SUCCESSFUL;
}

rtems_status_code rtems_rate_monotonic_create(rtems_name, rtems_id* id) {
  if (const rtems_status_code refused = refusal_of(__func__)) return refused;
  if (rtems().periods.size() == rtems().limits.periods) return RTEMS_TOO_MANY;
  *id = ++rtems().last_id;
  rtems().periods[*id] = {};
  return RTEMS_SUCCESSFUL;
}

// The first call starts the period. Later ones wait for its end, or return RTEMS_TIMEOUT at once, once for
// each deadline that has passed; the deadlines stay where they are.
rtems_status_code rtems_rate_monotonic_period(rtems_id id, rtems_interval length) {
  if (const rtems_status_code refused = refusal_of(__func__)) return refused;
  RtemsStub::Period* const period = find(rtems().periods, id);
  if (period == nullptr) return RTEMS_INVALID_ID;
  postpone(*period, length);
  if (period->postponed > 0) {
    --period->postponed;
    return RTEMS_TIMEOUT;
  }
  if (period->is_active) return wait_for_deadline(*period, length);
  period->is_active = true;
  period->deadline_ns = rtems().uptime_ns + length_ns(length);
  return RTEMS_SUCCESSFUL;
}

rtems_status_code rtems_rate_monotonic_get_status(rtems_id id, rtems_rate_monotonic_period_status* status) {
  if (const rtems_status_code refused = refusal_of(__func__)) return refused;
  const RtemsStub::Period* const period = find(rtems().periods, id);
  if (period == nullptr) return RTEMS_INVALID_ID;
  status->postponed_jobs_count = period->postponed;
  return RTEMS_SUCCESSFUL;
}

rtems_status_code rtems_rate_monotonic_delete(rtems_id id) {
  return rtems().periods.erase(id) == 1 ? RTEMS_SUCCESSFUL : RTEMS_INVALID_ID;
}

uint32_t rtems_configuration_get_microseconds_per_tick(void) {
  return rtems().limits.us_per_tick;
}

uint64_t rtems_clock_get_uptime_nanoseconds(void) {
  return static_cast<uint64_t>(rtems().uptime_ns);
}

void rtems_task_exit(void) {
  ++rtems().task_exits;
}
