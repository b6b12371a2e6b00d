// SimulatorEndpoints: the DDS readers and writers of the simulator, and a wait set for the answers.
#pragma once

#include <cstdint>

#include "hal/dds/idl/topics.hpp"

namespace tumblesight::sim {

struct SimulatorEndpoints {
  hal::dds::Writer<hal::dds::HelloSample> hello_out;
  hal::dds::Writer<hal::dds::LidarFrameSample> frames;
  hal::dds::Writer<hal::dds::NavigationSample> navigations;
  hal::dds::Writer<hal::dds::CommandSample> commands;
  hal::dds::Writer<hal::dds::StepSample> steps;
  hal::dds::Writer<hal::dds::TruthSample> truth;  // for displays; not read by flight
  hal::dds::Reader<hal::dds::HelloSample> hello_in;
  hal::dds::Reader<hal::dds::AttitudeSample> attitudes;
  hal::dds::Reader<hal::dds::TelemetrySample> telemetries;
  hal::dds::Reader<hal::dds::EventSample> events;
  hal::dds::Reader<hal::dds::MemoryDumpSample> dumps;
  hal::dds::Reader<hal::dds::StepDoneSample> steps_done;

  explicit SimulatorEndpoints(const hal::dds::Domain& domain);  // throws SilFailure
  // Of what is sent for a step.
  auto& writer_of(const hal::dds::LidarFrameSample&) { return frames; }
  auto& writer_of(const hal::dds::NavigationSample&) { return navigations; }
  auto& writer_of(const hal::dds::CommandSample&) { return commands; }
  auto& writer_of(const hal::dds::StepSample&) { return steps; }
  // Binds every reader to the flight program. True once every endpoint is matched with its counterpart there,
  // so that no sample is lost from now on.
  bool bind(const hal::dds::PeerKey& flight);
  bool flight_gone() const { return !steps_done.has_peer(); }
  // A program other than the flight program that writes to one of our topics.
  hal::dds::Foreigner foreigner() const;
  // Waits until there is an answer that was not taken yet (true), or the time is over (false).
  bool wait_for_data(std::int64_t timeout_ns);

 private:
  dds_entity_t waitset_ = 0;
};

}  // namespace tumblesight::sim
