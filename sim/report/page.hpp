// What HTML pages are made of: their frame, and their figures as inline SVG. A page is one self-contained
// file, without scripts, and loads nothing. A figure is an empty text where there is nothing to show.
#pragma once

#include <string>
#include <vector>

#include "sim/evaluation/results.hpp"
#include "sim/report/run_page.hpp"

namespace tumblesight::sim {

// `body` is markup; the title is plain text.
std::string html_page(const std::string& title, const std::string& body);
// A figure below its heading. Heading and caption are markup. Empty when `svg` is empty.
std::string html_figure(const std::string& heading, const std::string& svg, const std::string& caption);

// The lead of a page whose attitudes are mostly wrong. Markup.
std::string not_known_sentence(const std::string& target);

// Faults and remarks at the top of a page, lists of facts side by side, and the last lines.
std::string html_notices(const std::vector<std::string>& notices, const std::vector<std::string>& remarks);
std::string html_facts(const std::vector<FactList>& lists);
// How to open the recording of a run (MCAP) in the console; empty without one.
std::string html_console(const std::string& recording);
std::string html_footer(const std::string& generated, const std::string& command);

// Of one network on one mesh (results_figures.cpp).

// Mean error by condition: RCNN, CNN, template matching, the paper's RCNN.
std::string conditions_figure(const SubjectResult& subject);
std::string frames_figure(const SubjectResult& subject);
std::string range_figure(const CellResult& cell);
std::string rate_figure(const SubjectResult& subject);
std::string hidden_share_figure(const Sweeps& sweeps);
std::string long_run_figure(const Sweeps& sweeps);

// Of a software-in-the-loop run (run_figures.cpp).

std::string error_over_frames_figure(const RunReport& report);
std::string error_histogram_figure(const RunReport& report);
std::string predicted_error_figure(const RunReport& report);

// One sequence, a column per frame: the depth image where one was kept, below it the target's axes, true and
// estimated, in the image's perspective (LRF x to the right, z up), below that the error.
std::string attitude_strip_figure(const RunReport& report, std::uint32_t sequence);
std::string quaternion_figure(const RunReport& report, std::uint32_t sequence);
// The registered poses of all sequences, the first with those of one sequence frame by frame.
std::string pose_attitude_figure(const RunReport& report, std::uint32_t sequence);
std::string pose_position_figure(const RunReport& report);
std::string pose_verified_figure(const RunReport& report);

// Depth images side by side, each with its sequence, frame and range.
std::string gallery_figure(const std::vector<const ReportPicture*>& pictures);

}  // namespace tumblesight::sim
