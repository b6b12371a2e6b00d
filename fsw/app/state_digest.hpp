// The digest of the application's state, to compare runs on different processors and at different loads.
#pragma once

#include <cstdint>

#include "fsw/app/app_state.hpp"

namespace tumblesight::fsw {

// CRC-32 over the estimator's state, the active model's CRC and every member of the application's state but
// those that the wall clock or the platform decides. state_digest.cpp names both kinds.
std::uint32_t digest_of(const AppState& state, const Estimator& estimator);

}  // namespace tumblesight::fsw
