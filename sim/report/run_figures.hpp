// The figures of a run's report, each as inline SVG.
#pragma once

#include <string>
#include <vector>

#include "sim/report/run_page.hpp"

namespace tumblesight::sim {

std::string error_over_frames_figure(const RunReport& report);
std::string error_histogram_figure(const RunReport& report);
std::string predicted_error_figure(const RunReport& report);

// One sequence, a column per frame: the depth image where one was kept, below it the target's axes, true and
// estimated, in the image's perspective (LRF x to the right, z up), below that the error.
std::string attitude_strip_figure(const RunReport& report, std::uint32_t sequence);
std::string quaternion_figure(const RunReport& report, std::uint32_t sequence);

// Depth images side by side, each with its sequence, frame and range.
std::string gallery_figure(const std::vector<const ReportPicture*>& pictures);

}  // namespace tumblesight::sim
