// StepContent: the number and the CRC-32 of the samples that belong to one lockstep step. Both sides compute
// them, so that a step is carried out only with the samples that the simulator sent with it:
// their sequence numbers, exposure times, run id, k and data.
#pragma once

#include <cstdint>

#include "gnc/numerics/crc.hpp"
#include "hal/dds/idl/topics.hpp"

namespace tumblesight::hal::dds {

class StepContent {
 public:
  // In the order of their topic. Topics may be mixed, because DDS keeps no order across them.
  void add(const LidarFrameSample& frame);
  void add(const NavigationSample& navigation);
  void add(const CommandSample& command);

  // Writes the numbers and the CRC to the step.
  void announce_in(StepSample& step) const;
  // Whether at least as many samples as announced are here.
  bool has_all_of(const StepSample& step) const;
  // Whether they are the announced ones.
  bool is_that_of(const StepSample& step) const;

 private:
  std::uint32_t crc32() const;

  int frames_ = 0;
  int navigations_ = 0;
  int commands_ = 0;
  gnc::Crc32 frame_bytes_;
  gnc::Crc32 navigation_bytes_;
  gnc::Crc32 command_bytes_;
};

}  // namespace tumblesight::hal::dds
