// How a periodic task counts the releases that passed while it was busy.
#pragma once

#include <cstdint>

namespace tumblesight::hal::rtos {

// `slips` saturates.
inline void add_missed(std::uint32_t missed, std::uint32_t& slips) {
  slips = missed < UINT32_MAX - slips ? slips + missed : UINT32_MAX;
}

}  // namespace tumblesight::hal::rtos
