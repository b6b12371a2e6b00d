// The report of a software-in-the-loop run: its figures, JSON, page and faults.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gnc/lidar/depth_image.hpp"
#include "sim/evaluation/float32_reference.hpp"
#include "sim/report/run_page.hpp"
#include "sim/sil/sil_run.hpp"

namespace tumblesight::sim {

// The settings of the run.
struct SilRunSetup {
  std::string target;
  std::string mesh_name;
  std::string condition;
  std::uint32_t sequences = 0;
  std::uint32_t frames = 0;  // per sequence
  std::uint64_t seed = 0;
  std::string model_path;
  std::string model_crc32;  // or why the host's own check refuses the image
  gnc::DepthProjection projection;
  double speed = 0.0;  // times real time; 0: as fast as the machine goes
  bool free_running = false;
  Disturbances disturbances;
  std::vector<std::string> remarks;
};

// Answered steps only.
std::vector<FrameResult> frame_results(const SilRunResult& run);

struct InferenceTime {
  double median_us = 0.0;
  double max_us = 0.0;
};
// Over the steps that gave an attitude; zeros if none did.
InferenceTime inference_time(const SilRunResult& run);

// The faults of the run, one sentence each. Empty: every step was answered, with an attitude if the sensor
// delivered a genuine frame, and the flight task allocated no heap memory.
std::vector<std::string> run_faults(const SilRunResult& run);

nlohmann::ordered_json run_json(const SilRunSetup& setup, const SilRunResult& run,
                                const std::optional<NumericsComparison>& numerics = {});
RunReport run_report(const SilRunSetup& setup, const SilRunResult& run,
                     const std::optional<NumericsComparison>& numerics = {});

}  // namespace tumblesight::sim
