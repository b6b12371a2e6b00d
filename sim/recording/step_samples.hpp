// The samples of the bus in which the simulator sends a step, and what they are made of.
#pragma once

#include <cstdint>

#include "gnc/attitude/chaser_attitude.hpp"
#include "gnc/lidar/range_image.hpp"
#include "hal/dds/idl/step_content.hpp"
#include "hal/dds/idl/topics.hpp"
#include "hal/messages/command_packet.hpp"
#include "sim/recording/run_step.hpp"
#include "sim/world/sensor/frame_truth.hpp"

namespace tumblesight::sim {

struct StepOfRun {
  std::uint32_t run_id = 0;
  std::uint32_t k = 0;
};

// In place, since a frame is large.
void fill(hal::dds::LidarFrameSample& sample, const StepOfRun& step, const gnc::RangeImage& frame);
gnc::RangeImage frame_of(const hal::dds::LidarFrameSample& sample);
hal::dds::NavigationSample navigation_sample(const StepOfRun& step, const gnc::ChaserAttitude& attitude);
gnc::ChaserAttitude attitude_of(const hal::dds::NavigationSample& sample);
hal::dds::CommandSample command_sample(const StepOfRun& step, const hal::CommandPacket& packet);
hal::CommandPacket packet_of(const hal::dds::CommandSample& sample);
// `sequence`, `frame`: indices. `time_ns`: of the step.
hal::dds::TruthSample truth_sample(const StepOfRun& step, std::uint32_t sequence, std::uint32_t frame,
                                   const FrameTruth& truth, std::int64_t time_ns);
// Where the target is off the boresight is not in it.
FrameTruth frame_truth_of(const hal::dds::TruthSample& sample);

// Calls write(sample) for every sample of a step: its frames, attitudes of the chaser and packets (its
// telecommands must be among them), and what announces them. `frame_sample`: where a frame is written to.
template <class Write>
void write_step(const StepOfRun& step, const StepInput& input, hal::dds::LidarFrameSample& frame_sample,
                const Write& write) {
  hal::dds::StepContent content;
  const auto add = [&](const auto& sample) {
    write(sample);
    content.add(sample);
  };
  for (const gnc::RangeImage* frame : input.frames) {
    fill(frame_sample, step, *frame);
    add(frame_sample);
  }
  for (const gnc::ChaserAttitude& attitude : input.navigations) add(navigation_sample(step, attitude));
  for (const hal::CommandPacket& packet : input.packets) add(command_sample(step, packet));
  hal::dds::StepSample announced{};
  announced.run_id = step.run_id;
  announced.k = step.k;
  announced.time_ns = input.time_ns;
  announced.last = input.last ? 1 : 0;
  content.announce_in(announced);
  write(announced);
}

}  // namespace tumblesight::sim
