// Shared by the SIL tests: a model with arbitrary weights, frames, settings, and the state of processes.
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

// A new file name at each call, in a folder that is removed at the end of the process.
std::string temporary_path(const std::string& name);
void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes);
std::string read_file(const std::string& path);

// A valid model image for kTarget: arbitrary weights, the real shape.
const std::vector<std::uint8_t>& model_bytes();
const std::string& model_path();

// The flight program of this build, a free domain, and a file for the program's messages.
SilSettings settings();
// The same for NEAR Shoemaker with the model that flies. `mcap_path`: recording of the run; empty: none.
SilSettings shipped_settings(const std::string& mcap_path = "");
// A run with them over sequences(count, 1).
SilRunResult run_shipped(const std::string& mcap_path, int count);

// `tumblesight simulate` with two sequences as another process, as a user starts it: one process opens a
// domain only once. Returns what it printed, which it throws as
// std::runtime_error if the program fails.
std::string simulate(const std::string& options);
// The line of it that has the checksum over the run's trace.
std::string trace_of(const std::string& printed);

const FlashLidar& lidar();
std::vector<Sequence> sequences(int count, std::uint64_t seed);
// Good frames of one sequence.
const std::vector<gnc::RangeImage>& frames();

// Sends frames with sequence numbers and exposure times that follow the steps. A test may modify them.
class Conversation {
 public:
  explicit Conversation(const SilSettings& settings) : session(settings) {}

  static std::int64_t time_ns(std::uint32_t k) { return (k + 1) * kFramePeriod_ns; }
  gnc::RangeImage good_frame() const;
  StepAnswer step(const std::vector<gnc::RangeImage>& frames_of_step, std::vector<Telecommand> commands = {},
                  bool last = false);
  StepAnswer step() { return step({good_frame()}); }
  StepAnswer finish();  // a last step with a good frame; expects flight to end cleanly

  SilSession session;
  std::uint32_t k = 0;  // of the next step
};

// A free domain that no run selects by itself, for tests that need its number before the run. No other test
// process gets it while this one lives.
int spare_domain();

// The file that a killed simulator leaves.
void leave_announcement_of_killed_run(int domain);

// Sets an environment variable during its lifetime, for this process and its children.
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

// Process id of the flight program started by this process; 0: there is none.
pid_t flight_child();

}  // namespace tumblesight::sim::test
