// RtemsStub: queues and rate-monotonic periods as RTEMS 6 has them, for one task in virtual time. Time passes
// only while the task waits, or when a test sets it.
#pragma once

#include <rtems.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace tumblesight::test {

struct RtemsLimits {
  std::uint32_t message_queues = 7;
  std::uint32_t periods = 1;
  std::uint32_t us_per_tick = 10'000;
};

struct RtemsStub {
  struct Queue {
    std::size_t message_size = 0;
    std::uint32_t depth = 0;
    std::deque<std::vector<char>> messages;
  };
  struct Period {
    bool is_active = false;
    std::int64_t deadline_ns = 0;
    std::uint32_t postponed = 0;
  };

  RtemsLimits limits;
  std::int64_t uptime_ns = 0;
  std::map<std::string, rtems_status_code> refusals;  // status that a function returns at once
  // When a task that has waited is released. May set its time, and with it those of the later releases.
  // False: the task cannot go on.
  std::function<bool(std::int64_t& now_ns)> on_release;
  int task_exits = 0;

  std::map<rtems_id, Queue> queues;
  std::map<rtems_id, Period> periods;
  rtems_id last_id = 0;
};

// Reset it before each test: rtems() = {}.
RtemsStub& rtems();

}  // namespace tumblesight::test

extern const tumblesight::test::RtemsLimits rtems_configured;  // of a program
