// RunSource: where the run that a console shows comes from: a bus that is running, or a recording.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/console/step_log.hpp"

namespace tumblesight::sim {

class RunSource {
 public:
  virtual ~RunSource() = default;
  virtual const StepLog& log() const = 0;
  virtual const char* kind() const = 0;  // "bus" or "recording"
  virtual std::string title() const = 0;
  // False: a recording whose writer was killed.
  virtual bool is_whole() const { return true; }
  // The first step whose frame is kept.
  virtual std::uint64_t first_frame() const = 0;
  // Sends a request to the run (RunControl), and returns its answer. Throws std::runtime_error that says why
  // there is none.
  virtual std::string ask(const std::string& request) const = 0;
  // The frame of a step, the last if it has several. False: there is none.
  virtual bool frame(std::uint64_t step, gnc::RangeImage& frame) const = 0;
};

}  // namespace tumblesight::sim
