// The report of a software-in-the-loop run: its figures, JSON, page and faults.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hal/messages/fault.hpp"
#include "sim/evaluation/float32_reference.hpp"
#include "sim/report/run_page.hpp"
#include "sim/sil/sil_run.hpp"

namespace tumblesight::sim {

// The pose in a report of the flight program.
StatedPose stated_pose(const hal::AttitudeReport& report);

// Answered steps only. `swath_m`: of the renderer that made the frames; without it there are no poses, for
// runs whose truth does not hold position and velocity. Errors are to the nearest attitude that looks the
// same.
std::vector<FrameResult> frame_results(const SilRunResult& run, std::optional<double> swath_m,
                                       const TargetSymmetry& symmetry = {});

struct InferenceTime {
  double median_us = 0.0;
  double max_us = 0.0;
};
// Over the steps that gave an attitude; zeros if none did.
InferenceTime inference_time(const SilRunResult& run);
// "30 of 30 answered"; "12 of 30 answered, 18 superseded by a newer frame of the same cycle".
std::string steps_text(const SilRunResult& run);
// "1.25 ms"; "none" for 0.
std::string time_text(double time_us);

// The faults of the run, one sentence each. Empty: every step was answered, no telecommand was refused, and
// the flight task allocated no heap memory.
std::vector<std::string> flight_faults(const SilRunResult& run);
// Also those of a run that owes an attitude for every genuine frame.
std::vector<std::string> run_faults(const SilRunResult& run);

// What reports of all runs have: figures of the flight program, its counters at the end, and its warnings and
// errors by event, in the order in which they first occurred.
FactList outcome_facts(const SilRunResult& run, const FlightSetup& setup);
FactList counter_facts(const SilRunResult& run);
FactList event_facts(const SilRunResult& run);
nlohmann::ordered_json outcome_json(const SilRunResult& run);
// The pictures of the run as the network sees them.
std::vector<ReportPicture> depth_pictures(const SilRunResult& run, const gnc::DepthProjection& projection);

// A fault that the flight program's telemetry showed as persisting.
struct StandingFault {
  hal::Fault fault = hal::Fault::kStateLost;
  std::uint32_t steps = 0;       // in which it stood
  std::uint32_t sequences = 0;   // that have such a step
  std::uint32_t first_step = 0;  // the first of these steps, from 0
};
// In the order of their numbers.
std::vector<StandingFault> standing_faults(const SilRunResult& run);
// "FRAME_FROZEN in 12 steps of 4 sequences, OUTAGE in 1 step of 1 sequence"; "none" without one.
std::string text_of(const std::vector<StandingFault>& faults);

// "step 41: debris 1.5 m for 5 steps", several with a semicolon between them; the first ones of many; "none".
std::string text_of(const std::vector<RunRequest>& requests);

nlohmann::ordered_json run_json(const SilRunSetup& setup, const SilRunResult& run,
                                const std::optional<NumericsComparison>& numerics = {});
RunReport run_report(const SilRunSetup& setup, const SilRunResult& run,
                     const std::optional<NumericsComparison>& numerics = {});

}  // namespace tumblesight::sim
