// What the SIL tests share: a model with arbitrary weights, frames, settings, and a look at the processes.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/sil/sil_run.hpp"
#include "sim/sil/sil_session.hpp"

namespace tumblesight::sim::test {

inline constexpr const char* kTarget = "test_target";
inline constexpr double kSwath_m = 8.0;

// A file of its own for each call in a folder that goes with the process.
std::string temporary_path(const std::string& name);
void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes);
std::string read_file(const std::string& path);

// A valid model image for kTarget: arbitrary weights, the real shape.
const std::vector<std::uint8_t>& model_bytes();
const std::string& model_path();

// The real flight program, a free domain, its messages in a file.
SilSettings settings();

const FlashLidar& lidar();
std::vector<Sequence> sequences(int count, std::uint64_t seed);
// Good frames of one sequence.
const std::vector<gnc::RangeImage>& frames();

// Sends frames with sequence numbers and exposure times that follow the steps; a test spoils what it wants
// spoilt.
class Conversation {
 public:
  explicit Conversation(const SilSettings& settings) : session(settings) {}

  static std::int64_t time_ns(std::uint32_t k) { return (k + 1) * kFramePeriod_ns; }
  gnc::RangeImage good_frame() const;
  StepAnswer step(const std::vector<gnc::RangeImage>& frames_of_step, std::vector<Telecommand> commands = {},
                  bool last = false);
  StepAnswer step() { return step({good_frame()}); }
  StepAnswer finish();  // a good step that is the last, and flight's clean end

  SilSession session;
  std::uint32_t k = 0;  // of the next step
};

// A domain that is free and that no run chooses by itself, for who needs its number before the run.
int spare_domain();

// Sets an environment variable while it lives, for this process and those it starts.
class Environment {
 public:
  Environment(const char* name, const std::string& value);
  ~Environment();
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

// Process id of the flight program that this process has started; 0: there is none.
pid_t flight_child();

}  // namespace tumblesight::sim::test
