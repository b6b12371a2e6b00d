// DdsNavigation: the samples of topic sil/navigation as the navigation of the chaser. The bus thread puts
// them in, the flight task asks for them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/dds/idl/topics.hpp"
#include "hal/dds/mailbox_lock.hpp"
#include "hal/navigation.hpp"

namespace tumblesight::hal::dds {

class DdsNavigation final : public Navigation {
 public:
  // Keeps the latest samples, two lockstep steps of them.
  void put(const NavigationSample& sample);

  [[nodiscard]] gnc::ChaserAttitude attitude_at(std::int64_t time_ns) override;

 private:
  MailboxMutex mutex_;
  std::array<gnc::ChaserAttitude, 2 * kMaxFramesPerStep> kept_{};
  std::size_t next_ = 0;  // to be overwritten
};

}  // namespace tumblesight::hal::dds
