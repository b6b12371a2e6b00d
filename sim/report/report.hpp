// Report: what happened in a software-in-the-loop run, as one self-contained HTML page (no scripts, nothing
// loaded).
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "gnc/lidar/depth_image.hpp"
#include "sim/evaluation/metrics.hpp"
#include "sim/evaluation/paper.hpp"

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

struct RunReport {
  std::string target;
  std::string condition;
  std::string command;    // what was run
  std::string generated;  // when, for the reader
  std::uint32_t sequences = 0;
  std::uint32_t frames = 0;  // a sequence
  double frame_period_s = 0.0;
  std::vector<FrameResult> results;  // answered steps only
  std::vector<ReportPicture> pictures;
  PaperFigures paper;
  std::uint32_t steps_planned = 0;
  std::uint32_t steps_missed = 0;
  std::uint32_t heap_allocations = 0;
  double inference_median_us = 0.0;
  double inference_max_us = 0.0;
  std::uint32_t trace_crc32 = 0;
  std::vector<std::string> notices;  // what went wrong; shown at the top
  std::vector<std::string> remarks;  // what else a reader should know; shown below them
  std::vector<FactList> facts;       // settings, counters
};

std::string compose_report(const RunReport& report);

}  // namespace tumblesight::sim
