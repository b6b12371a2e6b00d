#include "hal/dds/idl/step_content.hpp"

namespace tumblesight::hal::dds {
namespace {

void add_time(gnc::Crc32& crc, std::int64_t time_ns) {
  const auto bits = static_cast<std::uint64_t>(time_ns);
  crc.add_u32(static_cast<std::uint32_t>(bits));
  crc.add_u32(static_cast<std::uint32_t>(bits >> 32));
}

}  // namespace

void StepContent::add(const LidarFrameSample& frame) {
  ++frames_;
  frame_bytes_.add_u32(frame.run_id);
  frame_bytes_.add_u32(frame.k);
  frame_bytes_.add_u32(frame.sequence_number);
  add_time(frame_bytes_, frame.exposure_time_ns);
  frame_bytes_.add_u32(frame.fov_urad);
  frame_bytes_.add_u32(frame.rays);
  // Both sides run on the same machine, so the order of the bytes is the same.
  frame_bytes_.add(reinterpret_cast<const unsigned char*>(frame.ranges), sizeof frame.ranges);
}

void StepContent::add(const NavigationSample& navigation) {
  ++navigations_;
  navigation_bytes_.add_u32(navigation.run_id);
  navigation_bytes_.add_u32(navigation.k);
  add_time(navigation_bytes_, navigation.time_ns);
  for (const std::int32_t part : navigation.q_inertial_lrf)
    navigation_bytes_.add_u32(static_cast<std::uint32_t>(part));
  navigation_bytes_.add_u32(navigation.valid);
}

void StepContent::add(const CommandSample& command) {
  ++commands_;
  command_bytes_.add_u32(command.run_id);
  command_bytes_.add_u32(command.k);
  command_bytes_.add_u32(command.size);
  command_bytes_.add(command.bytes, sizeof command.bytes);
}

void StepContent::announce_in(StepSample& step) const {
  step.frames = static_cast<std::uint8_t>(frames_);
  step.navigations = static_cast<std::uint8_t>(navigations_);
  step.commands = static_cast<std::uint8_t>(commands_);
  step.content_crc32 = crc32();
}

bool StepContent::has_all_of(const StepSample& step) const {
  return frames_ >= step.frames && navigations_ >= step.navigations && commands_ >= step.commands;
}

bool StepContent::is_that_of(const StepSample& step) const {
  return frames_ == step.frames && navigations_ == step.navigations && commands_ == step.commands &&
         crc32() == step.content_crc32;
}

std::uint32_t StepContent::crc32() const {
  gnc::Crc32 crc;
  crc.add_u32(frame_bytes_.value());
  crc.add_u32(navigation_bytes_.value());
  crc.add_u32(command_bytes_.value());
  return crc.value();
}

}  // namespace tumblesight::hal::dds
