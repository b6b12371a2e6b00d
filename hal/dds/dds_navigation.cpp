#include "hal/dds/dds_navigation.hpp"

#include <algorithm>
#include <iterator>

namespace tumblesight::hal::dds {
namespace {

// Without overflow for any two times.
std::uint64_t distance_ns(std::int64_t a, std::int64_t b) {
  const auto difference = static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b);
  return a < b ? ~difference + 1 : difference;
}

}  // namespace

void DdsNavigation::put(const NavigationSample& sample) {
  const MailboxLock lock(mutex_);
  gnc::ChaserAttitude& attitude = kept_[next_];
  next_ = (next_ + 1) % kept_.size();
  attitude.time_ns = sample.time_ns;
  std::copy(std::begin(sample.q_inertial_lrf), std::end(sample.q_inertial_lrf),
            attitude.q_inertial_lrf.begin());
  attitude.valid = sample.valid == 1;
}

gnc::ChaserAttitude DdsNavigation::attitude_at(std::int64_t time_ns) {
  const MailboxLock lock(mutex_);
  gnc::ChaserAttitude nearest;
  for (const gnc::ChaserAttitude& attitude : kept_) {
    if (!attitude.valid) continue;
    if (nearest.valid && distance_ns(attitude.time_ns, time_ns) >= distance_ns(nearest.time_ns, time_ns))
      continue;
    nearest = attitude;
  }
  return nearest;
}

}  // namespace tumblesight::hal::dds
