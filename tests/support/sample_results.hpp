// Made-up results: of single frames, and of two subjects in the form of an experiment's results, with chosen
// errors.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "sim/evaluation/metrics.hpp"
#include "sim/evaluation/results.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {

// Results with chosen errors.
inline Eigen::Quaterniond turned(double angle_deg, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_deg * kRadPerDeg, axis.normalized()));
}

inline FrameResult result_with(std::uint32_t sequence, std::uint32_t frame, double rcnn_deg, double cnn_deg) {
  FrameResult made;
  made.sequence = sequence;
  made.frame = frame;
  made.valid = true;
  made.truth = turned(70.0, {1.0, -2.0, 0.5});
  made.rcnn = turned(rcnn_deg, {0.3, 0.1, 1.0}) * made.truth;
  made.cnn = turned(cnn_deg, {-1.0, 0.4, 0.2}) * made.truth;
  return made;
}

// Results of two subjects in the form of an experiment's results, with chosen errors.
inline CellResult sample_cell(Condition condition, double rcnn_deg, bool baseline) {
  std::vector<FrameResult> frames;
  for (std::uint32_t i = 0; i < 80; ++i) {
    frames.push_back(result_with(i / 2, i % 2, rcnn_deg + 0.1 * i, 30.0 + i));
    frames.back().range_m = 20.5 + i;
    frames.back().rate_rad_s = 0.004 * i;
    frames.back().rcnn_predicted_rad = 0.01 * i;
  }
  const std::vector<FrameResult> last = last_frames(frames, 2);
  CellResult cell;
  cell.condition = condition;
  cell.sequences = 40;
  cell.frames = 2;
  cell.rcnn = last_frame_summary(frames, 2, Estimator::kRcnn);
  cell.cnn = last_frame_summary(frames, 2, Estimator::kCnn);
  if (baseline) {
    cell.baseline = summarise({1.0, 2.0, 90.0});
    cell.baseline_histogram = histogram({1.0, 2.0, 90.0});
  }
  cell.step_ms = 0.5;
  cell.baseline_ms = 123.0;
  cell.by_frame = errors_by_frame(frames, 2);
  cell.by_range = errors_by_range(last);
  cell.by_rate = errors_by_rate(last);
  cell.rcnn_histogram = histogram(last_frame_errors_deg(frames, 2, Estimator::kRcnn));
  cell.cnn_histogram = histogram(last_frame_errors_deg(frames, 2, Estimator::kCnn));
  cell.rcnn_confusion = confusion(last, Estimator::kRcnn, near_symmetries("near_shoemaker"));
  cell.cnn_confusion = confusion(last, Estimator::kCnn, near_symmetries("near_shoemaker"));
  cell.reliability = reliability(frames);
  cell.detection = detection(frames);
  return cell;
}

// Figures of poses that differ from each other.
inline PoseSummary sample_poses() {
  PoseSummary poses;
  poses.count = 40;
  poses.known = 1.0;
  poses.mean_deg = 1.5;
  poses.mean_within_20_deg = 0.25;
  poses.median_deg = 0.125;
  poses.within_20deg = 0.975;
  poses.across_m = 0.0031;
  poses.along_m = 0.0042;
  poses.rate_deg_s = 0.0153;
  poses.velocity_m_s = 0.0064;
  poses.verified = 0.9;
  poses.verified_wrong = 0.05;
  poses.inside_95 = 0.925;
  return poses;
}

inline Results sample_results() {
  SubjectResult near{"near_shoemaker", "near, \"odd\".stl", "near_shoemaker", 0x00C0FFEE, {}, {}, {}, {}};
  near.cells = {sample_cell(Condition::kNominal, 1.0, true), sample_cell(Condition::kOccluded, 15.0, true)};
  Sweeps sweeps;
  sweeps.by_rate_norm = near.cells.front().by_rate;
  sweeps.by_hidden_share = {{0.05, near.cells[0].rcnn, near.cells[0].cnn},
                            {0.5, near.cells[1].rcnn, near.cells[1].cnn}};
  for (int frame = 1; frame <= 30; ++frame) {
    sweeps.long_run.push_back({static_cast<double>(frame), near.cells[0].rcnn, near.cells[0].cnn});
  }
  near.sweeps = sweeps;
  SubjectResult mine{
      "mine", kParametricMesh, "other", 0x12345678, {sample_cell(Condition::kOffset, 3.0, false)}, {}, {},
      {}};
  Results results;
  results.seed = 7;
  results.command = "tumblesight evaluate --paper";
  results.notes = {"magellan is left out: no model ships yet."};
  results.subjects = {near, mine};
  return results;
}

}  // namespace tumblesight::sim
