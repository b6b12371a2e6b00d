// AnswerCollector: combines the samples of the flight program, which arrive in any order across topics, into
// one answer per step.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "hal/messages/attitude_report.hpp"
#include "hal/messages/event.hpp"
#include "hal/messages/telemetry.hpp"
#include "sim/sil/simulator_endpoints.hpp"

namespace tumblesight::sim {

struct StepAnswer {
  std::uint32_t k = 0;
  hal::AttitudeReport attitude;
  hal::Telemetry telemetry;
  std::vector<hal::Event> events;
  std::vector<std::uint8_t> dump;  // part of a model bank; empty: none
  std::uint32_t state_crc32 = 0;
  std::uint32_t samples = 0;  // of the bus, of which the answer was made
};

class AnswerCollector {
 public:
  AnswerCollector(SimulatorEndpoints& endpoints, std::uint32_t run_id)
      : endpoints_(endpoints), run_id_(run_id) {}

  // Takes all samples that have arrived. Throws SilFailure for a sample of another run.
  void collect();
  // The oldest complete answer, if there is one. Throws SilFailure if more samples than announced have
  // arrived.
  std::optional<StepAnswer> next();

 private:
  struct Partial {
    StepAnswer answer;
    std::uint32_t attitudes = 0;
    std::uint32_t telemetries = 0;
    std::uint32_t dumps = 0;
    std::uint32_t dones = 0;
    std::optional<hal::dds::StepDoneSample> done;
    bool complete() const;
    bool has_too_many() const;
  };
  // The step of a sample.
  template <class Sample>
  Partial& partial_of(const Sample& sample);

  SimulatorEndpoints& endpoints_;
  std::uint32_t run_id_;
  std::map<std::uint32_t, Partial> partials_;
};

}  // namespace tumblesight::sim
