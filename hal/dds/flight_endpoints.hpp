// FlightEndpoints: the DDS readers and writers of the flight program, and a wait for data on any reader.
#pragma once

#include <cstdint>

#include "hal/dds/idl/peer_life.hpp"
#include "hal/dds/idl/topics.hpp"

namespace tumblesight::hal::dds {

struct FlightEndpoints {
  Reader<HelloSample> hello_in;
  Reader<LidarFrameSample> frames;
  Reader<NavigationSample> navigations;
  Reader<CommandSample> commands;
  Reader<StepSample> steps;
  Writer<HelloSample> hello_out;
  Writer<AttitudeSample> attitudes;
  Writer<TelemetrySample> telemetries;
  Writer<EventSample> events;
  Writer<MemoryDumpSample> dumps;
  Writer<StepDoneSample> steps_done;
  PeerLife life;

  // Creates all endpoints. Returns 0 or a negative DDS return code.
  [[nodiscard]] dds_return_t open(const Domain& domain);
  std::uint32_t domain() const { return domain_; }
  // Binds every reader to the simulator. True once every endpoint is matched with the simulator's: no sample
  // is lost from then on.
  bool bind(const PeerKey& simulator);
  // The simulator has left, was killed, or its lease has expired.
  bool simulator_gone() const { return !steps.has_peer() || life.peer_ended(); }
  // A program other than the simulator that writes to one of our topics.
  Foreigner foreigner() const;
  // Waits until a frame, command or step is there to be taken, at most `timeout_ns`.
  void wait_for_data(std::int64_t timeout_ns) const;

 private:
  [[nodiscard]] dds_return_t wake_on(dds_entity_t reader) const;

  dds_entity_t waitset_ = 0;
  std::uint32_t domain_ = 0;
};

}  // namespace tumblesight::hal::dds
