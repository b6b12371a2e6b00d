// TemplateMatcher: the attitude of a known target from one LiDAR frame by the classical method. The frame is
// compared with renderings from all sides, and the best matches are refined by iterative closest points. It
// is the baseline of the evaluation.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/baseline/alignment.hpp"
#include "sim/baseline/signature.hpp"
#include "sim/world/sensor/flash_lidar.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// With the defaults a match takes 0.1..0.2 s on one core of a desktop, and the templates take 32 MB.
struct TemplateMatcherSettings {
  int directions = 1000;   // of view, evenly distributed over the sphere (1000: 6.5 degrees apart)
  int rolls = 36;          // about the boresight, for each direction; a multiple of 4
  int candidates = 20;     // attitudes that are refined
  int icp_iterations = 8;  // per candidate; the best few are then refined with up to twice as many more
  AlignmentPairs pairs = AlignmentPairs::kRangesAndSilhouette;
};

class TemplateMatcher {
 public:
  // Renders the templates, which takes about a second. `swath_m`: side of the square that holds the target at
  // any attitude (sim::swath_m). Throws std::invalid_argument that names the setting, its value and its
  // limit.
  TemplateMatcher(const TriangleMesh& mesh, double swath_m, const TemplateMatcherSettings& settings = {});

  struct Result {
    Eigen::Quaterniond q_lrf_trf = Eigen::Quaterniond::Identity();
    double residual_m = 0.0;  // see Alignment::residual_m
    bool valid = false;       // false: too few returns, or a frame outside the sensor's limits
  };
  // The target may be off the boresight. Returns nearer than gnc::kMinRange_m count as the chaser itself.
  // Thread-safe. The same frame gives the same result.
  Result match(const gnc::RangeImage& frame) const;

 private:
  struct Template {
    Signature signature;
    Eigen::Quaterniond q_view_trf;  // view frame: +y towards the centroid of the returns
    Eigen::Vector3d origin_view_m;  // origin of the TRF, relative to the point at the mean range on that line
  };
  struct Candidate {
    double difference;
    int entry;          // index in templates_
    int quarter_turns;  // by which the frame was rolled to match it
    int centre;         // index of the assumed centre
  };

  void render_templates();
  std::vector<Candidate> ranked(const TargetScan& scan, const std::vector<Eigen::Vector3d>& centres) const;
  TargetPose pose_of(const Candidate& candidate, const Eigen::Vector3d& centre, double range_m) const;
  std::vector<TargetPose> starts(const TargetScan& scan) const;

  TemplateMatcherSettings settings_;
  double target_radius_m_;
  double swath_m_;
  FlashLidar lidar_;
  Alignment alignment_;
  std::vector<Template> templates_;
};

}  // namespace tumblesight::sim
