// Every topic of the bus, by its type.
#pragma once

#include "hal/dds/idl/topics.hpp"

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

}  // namespace tumblesight::sim
