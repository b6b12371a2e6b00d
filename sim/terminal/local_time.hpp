// The time of day, for reports.
#pragma once

#include <string>

namespace tumblesight::sim {

// Now, in the local time zone: "2026-03-14 09:26 CET".
std::string local_time_text();

}  // namespace tumblesight::sim
