// From what a software-in-the-loop run recorded to what is shown of it: figures, JSON, report, verdict.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sim/cli/float32_beside.hpp"
#include "sim/cli/target_setup.hpp"
#include "sim/report/report.hpp"
#include "sim/sil/sil_run.hpp"

namespace tumblesight::sim {

// Answered steps only.
std::vector<FrameResult> frame_results(const SilRecording& recording);

struct InferenceTime {
  double median_us = 0.0;
  double max_us = 0.0;
};
// Over the steps that gave a valid attitude; zeros if none did.
InferenceTime inference_time(const SilRecording& recording);

// What is wrong with the run, a sentence each; empty: every step was answered with an attitude and the flight
// task's heap stayed untouched.
std::vector<std::string> shortcomings(const SilRecording& recording);

nlohmann::ordered_json run_json(const ScenarioArguments& scenario, const SilRecording& recording,
                                const std::optional<NumericsComparison>& numerics = {});
FactList numerics_facts(const NumericsComparison& numerics);
RunReport run_report(const ScenarioArguments& scenario, const TargetSetup& setup, const SilSettings& settings,
                     const SilRecording& recording);

}  // namespace tumblesight::sim
