// FlightEndpoints: the flight program's readers and writers, and one place to wait for any of them.
#pragma once

#include <cstdint>

#include "hal/dds/idl/topics.hpp"

namespace tumblesight::hal::dds {

struct FlightEndpoints {
  Reader<HelloSample> hello_in;
  Reader<LidarFrameSample> frames;
  Reader<CommandSample> commands;
  Reader<StepSample> steps;
  Writer<HelloSample> hello_out;
  Writer<AttitudeSample> attitudes;
  Writer<TelemetrySample> telemetries;
  Writer<EventSample> events;
  Writer<ModelDumpSample> dumps;
  Writer<StepDoneSample> steps_done;

  // 0 or a negative DDS return code.
  [[nodiscard]] dds_return_t open(dds_entity_t participant);
  // Every endpoint has its counterpart: nothing will be lost from now on.
  bool all_matched() const;
  // The time master has left, or its lease has run out.
  bool simulator_gone() const { return steps.matched() == 0; }
  // Until a frame, command or step has arrived that has not been taken, or the time is over.
  void wait_for_data(std::int64_t timeout_ns) const;

 private:
  [[nodiscard]] dds_return_t wake_on(dds_entity_t reader) const;

  dds_entity_t waitset_ = 0;
};

}  // namespace tumblesight::hal::dds
