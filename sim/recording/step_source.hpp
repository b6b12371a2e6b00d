// StepSource: where the steps of a run come from: simulated sequences or a recording.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "sim/operations/fault_table.hpp"
#include "sim/recording/run_step.hpp"

namespace tumblesight::sim {

struct SourcedStep {
  StepResult step;            // sequence, frame, time and truth; the answer is still missing
  StepInput input;            // frames, attitudes of the chaser and commands; valid until the next step
  bool keep_picture = false;  // the frame belongs to SilRunResult::pictures
};

// Whether a frame is one of a recording's pictures: the first ten, and sixteen more evenly spread. `place`:
// of `places` along the recording.
inline bool is_pictured(std::size_t frame, std::size_t place, std::size_t places) {
  return frame < 10 || place % (1 + places / 16) == 0;
}

class StepSource {
 public:
  virtual ~StepSource() = default;
  virtual std::uint32_t steps() const = 0;
  // Mission time of step k, later than that of the step before.
  virtual std::int64_t time_ns(std::uint32_t k) const = 0;
  // The next step, from step 0 on. Must be called at most once per step.
  virtual SourcedStep next() = 0;
  // Whether telecommands may be added to those of the steps.
  virtual bool takes_telecommands() const { return true; }
  // Puts a fault of the scene (FaultRow::is_of_scene) that is possible into the next step and those after it.
  // Throws std::invalid_argument that says why it cannot be.
  virtual void begin_fault(const InjectedFault& fault) {
    throw std::invalid_argument("the frames of this run are recorded, and fault " + fault.name +
                                " has to be rendered: only drop, freeze and delay are possible");
  }
};

}  // namespace tumblesight::sim
