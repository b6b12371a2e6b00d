// The truth of recorded frames: a text file beside the recording, a line per frame (CSV). docs/icd.md
// describes it for users who write one from their own data.
//
// The first line names the columns, in any order:
//   sequence_number, exposure_time_ns          of the frame, as in the recording
//   q_lrf_trf_w, _x, _y, _z                    unit Hamilton quaternion, TRF to LRF
//   rate_lrf_x_rad_s, _y_, _z_                 of the target relative to inertial space; all three or none
//   trf_origin_lrf_x_m, _y_, _z_               position of the TRF's origin; all three or none
//   target                                     name of what the frames show; optional
//   sensor, sensor_crc32                       the sensor, as in to_string(SensorDescription); optional
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tumblesight::sim {

// The sensor that took a frame: crc32_of(SensorDescription) identifies it.
struct RecordedSensor {
  std::string name;
  std::uint32_t crc32 = 0;
};

// The truth of one frame.
struct RecordedTruth {
  std::uint32_t sequence_number = 0;
  std::int64_t exposure_time_ns = 0;
  Eigen::Quaterniond q_lrf_trf = Eigen::Quaterniond::Identity();  // unit
  std::optional<Eigen::Vector3d> rate_lrf_rad_s;
  std::optional<Eigen::Vector3d> trf_origin_lrf_m;
  std::string target{};  // empty: not known
  std::optional<RecordedSensor> sensor{};
  std::size_t line = 0;  // of the file, from 1
};

// By sequence number and exposure time.
using TruthTable = std::map<std::pair<std::uint32_t, std::int64_t>, RecordedTruth>;

// The path without ".tslr". Any other ending stays, so that run.1 and run.2 have different stems.
std::string recording_stem(std::string recording_path);
// frames.tslr -> frames.truth.csv; run.1 -> run.1.truth.csv
std::string truth_path_of(const std::string& recording_path);

// The file's text: numbers that are read as exactly the same values. The optional columns are there if the
// first row has them.
std::string truth_csv(const std::vector<RecordedTruth>& rows);

// The rows of the file's text. Empty lines are left out, and spaces around values ignored. `name`: of the
// file, for messages. Throws std::runtime_error that names file, line, column, value, limit and remedy.
TruthTable parse_truth(const std::string& text, const std::string& name);

// Throws std::runtime_error as parse_truth does, or if the file cannot be read.
TruthTable read_truth(const std::string& path);

}  // namespace tumblesight::sim
