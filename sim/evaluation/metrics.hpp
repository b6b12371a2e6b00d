// Metrics: angular errors of attitude estimates and their summaries.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/evaluation/pose_errors.hpp"

namespace tumblesight::sim {

// One frame of one sequence: the true attitude and the estimates. Quaternions TRF to LRF, of either sign, and
// approximately unit.
struct FrameResult {
  std::uint32_t sequence = 0;
  std::uint32_t frame = 0;  // index in the sequence
  bool valid = false;       // an estimate was given; otherwise the error counts as 180 degrees
  bool owed = true;         // the sensor delivered a genuine image; otherwise there need be no estimate
  bool trusted = false;     // and it passed every check: the report calls it valid, not doubtful
  Eigen::Quaterniond truth{1.0, 0.0, 0.0, 0.0};
  Eigen::Quaterniond rcnn{1.0, 0.0, 0.0, 0.0};  // from all frames of the sequence so far
  Eigen::Quaterniond cnn{1.0, 0.0, 0.0, 0.0};   // from this frame alone
  double rcnn_predicted_rad = 0.0;              // the expected errors of both estimates
  double cnn_predicted_rad = 0.0;
  double range_m = 0.0;
  double rate_rad_s = 0.0;      // norm
  bool has_baseline = false;    // the template matcher was run on this frame
  bool baseline_valid = false;  // it found an attitude
  Eigen::Quaterniond baseline{1.0, 0.0, 0.0, 0.0};
  PoseErrors pose;  // registered
};

// Each estimate becomes the attitude nearest to the truth that looks like it. The pose is not touched: see
// pose_errors().
void take_nearest_equivalents(FrameResult& result, const TargetSymmetry& symmetry);

// An estimate that is further off is wrong: the paper's limit.
inline constexpr double kWrong_deg = 20.0;

enum class Estimator { kRcnn, kCnn, kBaseline };

// theta = 2 acos|q . q_hat| (paper, loss), in [0, pi]. Computed with atan2, which is accurate for small
// angles too.
double angular_error_rad(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);
bool has_estimate(const FrameResult& result, Estimator estimator);
const Eigen::Quaterniond& estimate(const FrameResult& result, Estimator estimator);
double error_deg(const FrameResult& result, Estimator estimator);  // 0..180; 180 without an estimate

// Shares are 0..1 and include the limit. All zero if count is zero. NaN: the figure does not exist.
struct ErrorSummary {
  std::size_t count = 0;
  double mean_deg = 0.0;
  double mean_standard_error_deg = 0.0;
  double median_deg = 0.0;
  double within_20deg = 0.0;
  double within_5deg = 0.0;
  double mean_within_20_deg = 0.0;  // over those within 20 degrees; NaN if there are none
  double mean_within_20_standard_error_deg = 0.0;
  // Shares of all that are more than 20 degrees off, or within 20 degrees, and trusted. NaN where it is not
  // known which estimates are trusted.
  double wrong_and_valid = 0.0;
  double right_and_valid = 0.0;
  // Of those with an estimate: the share whose error is below three times its expected error, and the mean
  // expected error over the mean error. NaN without any, and where no error is expected.
  double error_below_3_expected = 0.0;
  double expected_over_real = 0.0;
};

ErrorSummary summarise(std::vector<double> errors_deg);
double median(std::vector<double> values);  // mean of the middle two for an even count; 0 if empty

// The last frame (index frames - 1) of every sequence that has one, in the order of `results`.
std::vector<FrameResult> last_frames(const std::vector<FrameResult>& results, std::uint32_t frames);
// Errors of one estimator in the last frames; for the baseline only where it was run.
std::vector<double> last_frame_errors_deg(const std::vector<FrameResult>& results, std::uint32_t frames,
                                          Estimator estimator);
// The summary of these errors, with the shares of trusted estimates.
ErrorSummary last_frame_summary(const std::vector<FrameResult>& results, std::uint32_t frames,
                                Estimator estimator);

// Share of the sequences with frames that have no trusted estimate in frame `first` (index) or later.
double share_never_trusted(const std::vector<FrameResult>& results, std::uint32_t first);

// The registered poses of frame `frame` (index) of every sequence that has one.
PoseSummary pose_summary(const std::vector<FrameResult>& results, std::uint32_t frame);

// The turn that most estimates are off by, in the axes of the target: estimate = truth * turn. A target whose
// axes differ from those of the training gives such a turn, and another spacecraft does not.
struct CommonTurn {
  double share = 0.0;  // of the results that are off by it, to within 20 degrees
  Eigen::AngleAxisd turn{0.0, Eigen::Vector3d::UnitX()};
};
// Of the first few hundred results.
CommonTurn common_turn(const std::vector<FrameResult>& results, Estimator estimator);

}  // namespace tumblesight::sim
