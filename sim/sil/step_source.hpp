// StepSource: where the steps of a run come from: simulated sequences or a recording.
#pragma once

#include <cstdint>

#include "sim/sil/sil_session.hpp"

namespace tumblesight::sim {

struct SourcedStep {
  StepResult step;            // sequence, frame, time and truth; the answer is still missing
  StepInput input;            // frames, attitudes of the chaser and commands; valid until the next step
  bool keep_picture = false;  // the frame belongs to SilRunResult::pictures
};

class StepSource {
 public:
  virtual ~StepSource() = default;
  virtual std::uint32_t steps() const = 0;
  // Mission time of step k, later than that of the step before.
  virtual std::int64_t time_ns(std::uint32_t k) const = 0;
  // The next step, from step 0 on. Must be called at most once per step.
  virtual SourcedStep next() = 0;
};

}  // namespace tumblesight::sim
