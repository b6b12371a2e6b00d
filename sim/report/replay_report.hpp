// The report of a recording that the flight program was run over: a row per cycle, its figures, JSON and
// page. Without the truth there are no errors, but validity, reasons and expected errors.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sim/report/data_table.hpp"
#include "sim/report/run_page.hpp"
#include "sim/sil/sil_run.hpp"
#include "sim/world/frame_renderer.hpp"

namespace tumblesight::sim {

struct ReplaySetup : FlightSetup {
  std::string recording;     // file
  std::string truth;         // file; empty: not known
  bool shows_target = true;  // false: the recording is known to show another body
  std::uint32_t frames = 0;  // of the recording
};

// A frame that was sent.
struct ReplayedFrame {
  std::int64_t cycle_time_ns = 0;  // of the step
  FrameStamp stamp;
  std::uint32_t returns = 0;  // rays with a range
  std::uint32_t nearer = 0;   // of them, those that the flight program leaves out as too near
  std::uint32_t farther = 0;  // and as too far
};
ReplayedFrame replayed_frame(const StepResult& step, const gnc::RangeImage& frame);

// Refused frames by the telemetry's counters.
enum class Refusal { kDuplicate, kStale, kBad, kRepeated, kWithoutChaser };
inline constexpr std::size_t kRefusals = 5;
const char* to_string(Refusal refusal);  // "duplicate"

// One answered cycle.
struct ReplayRow {
  std::uint32_t cycle = 0;  // from 0
  std::int64_t time_ns = 0;
  std::optional<ReplayedFrame> frame;
  hal::AttitudeReport attitude;
  std::optional<Refusal> refusal;
  std::string status;  // "valid", "doubtful: jump", "refused: duplicate", "no frame"
  bool has_attitude = false;
  bool truth_known = false;
  std::optional<double> error_deg;               // of an attitude whose truth is known
  std::optional<double> single_frame_error_deg;  // of this frame alone
};

struct ReplayReport {
  ReplaySetup setup;
  std::vector<ReplayRow> rows;
  // As of a run with simulated sequences, for the figures. A sequence is a track of the flight program, and
  // its results are the attitudes whose truth is known.
  RunReport run;
};

// `frames`: every frame that was sent, in order.
ReplayReport replay_report(const ReplaySetup& setup, const SilRunResult& run,
                           const std::vector<ReplayedFrame>& frames);

// A line per cycle; consecutive cycles without a frame have one line. Without truth there is no last column,
// the error.
DataTable replay_table(const ReplayReport& report);
// Cycles, frames, attitudes and refusals, and the expected errors.
FactList replay_facts(const ReplayReport& report);
// Errors of valid attitudes, of all, and of single frames; no rows without truth.
DataTable replay_errors_table(const ReplayReport& report);
// What the reader must know if most of the attitudes whose truth is known are wrong, see mostly_wrong_text().
// Empty otherwise, and if the frames show another body.
std::string mostly_wrong_text(const ReplayReport& report);
// What the reader must know if frames were sent and all of them were refused for what they hold, with the
// likely mistakes. Empty otherwise, and if the frames show another body.
std::string nothing_accepted_text(const ReplayReport& report);
nlohmann::ordered_json replay_json(const ReplayReport& report, const SilRunResult& run);
std::string replay_page(const ReplayReport& report);

}  // namespace tumblesight::sim
