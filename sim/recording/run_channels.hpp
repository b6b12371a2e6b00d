// RunChannels: the channels of a recording of a run, whoever writes it: the topics of the bus as they are,
// and what viewers show without set-up (foxglove_messages.hpp).
#pragma once

#include <map>
#include <string>

#include "hal/dds/idl/topics.hpp"
#include "sim/recording/mcap_writer.hpp"

namespace tumblesight::sim {

template <class Sample>
struct TypeOf {
  using type = Sample;
};

// Calls visit(TypeOf<Sample>(), "its name in the IDL") for every topic of the bus.
template <class Visit>
void each_topic(const Visit& visit) {
  visit(TypeOf<hal::dds::HelloSample>(), "Hello");
  visit(TypeOf<hal::dds::LidarFrameSample>(), "LidarFrame");
  visit(TypeOf<hal::dds::NavigationSample>(), "Navigation");
  visit(TypeOf<hal::dds::CommandSample>(), "Command");
  visit(TypeOf<hal::dds::StepSample>(), "Step");
  visit(TypeOf<hal::dds::AttitudeSample>(), "Attitude");
  visit(TypeOf<hal::dds::TelemetrySample>(), "Telemetry");
  visit(TypeOf<hal::dds::EventSample>(), "Event");
  visit(TypeOf<hal::dds::MemoryDumpSample>(), "MemoryDump");
  visit(TypeOf<hal::dds::StepDoneSample>(), "StepDone");
  visit(TypeOf<hal::dds::TruthSample>(), "Truth");
}

struct RunChannels {
  explicit RunChannels(McapWriter& file);

  std::map<const hal::dds::Topic*, McapId> of_bus;
  McapId points, transforms, log, figures;
};

}  // namespace tumblesight::sim
