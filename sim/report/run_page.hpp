// The report of a software-in-the-loop run as an HTML page: one self-contained file, no scripts, nothing
// loaded.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "gnc/lidar/depth_image.hpp"
#include "sim/evaluation/metrics.hpp"
#include "sim/evaluation/paper.hpp"
#include "sim/evaluation/run_conditions.hpp"
#include "sim/report/data_table.hpp"

namespace tumblesight::sim {

struct ReportPicture {
  std::uint32_t sequence = 0;
  std::uint32_t frame = 0;
  double range_m = 0.0;
  gnc::DepthImage image;  // as the flight program sees the frame
};

struct FactList {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  // name, value
};

// The settings of a run of the flight program, whatever it sees.
struct FlightSetup {
  std::string target;
  std::string model_path;
  std::string model_crc32;
  gnc::DepthProjection projection;
  double speed = 0.0;  // times real time; 0: as fast as the machine goes
  bool free_running = false;
  std::vector<std::string> remarks;  // shown at the top of the report, below the faults
};

// The settings of a run with simulated sequences.
struct SilRunSetup : FlightSetup, RunConditions {
  std::string mesh_name;
  std::string condition;
  std::uint32_t sequences = 0;
  std::vector<std::uint32_t> only;  // their indices; empty: from 0
  std::uint32_t frames = 0;         // per sequence
  std::uint64_t seed = 0;
};

struct RunReport {
  SilRunSetup setup;
  std::string command;    // that was run
  std::string recording;  // of the run, as an MCAP file; empty: none
  std::string generated;  // date and time, as text
  double frame_period_s = 0.0;
  std::vector<FrameResult> results;  // answered steps only
  std::vector<ReportPicture> pictures;
  PaperFigures paper;
  std::uint32_t steps_planned = 0;
  std::uint32_t steps_missed = 0;
  std::uint32_t frames_superseded = 0;  // steps without an answer of their own that are not missed
  std::uint32_t heap_allocations = 0;
  double inference_median_us = 0.0;
  double inference_max_us = 0.0;
  std::uint32_t trace_crc32 = 0;
  std::vector<std::string> notices;  // faults of the run; shown at the top
  std::vector<FactList> facts;       // settings, counters
};

// Errors of RCNN and CNN in the last frame, with the paper's below them.
DataTable run_errors_table(const RunReport& report);

// The registered poses of first and last frames; no lines without poses.
DataTable run_poses_table(const RunReport& report);

// What the reader must know if most of the last frames are wrong, see mostly_wrong_text(). Empty otherwise,
// and if the frames show another body.
std::string mostly_wrong_text(const RunReport& report);

std::string run_page(const RunReport& report);

}  // namespace tumblesight::sim
