// TemplateMatcher: the attitude of a known target from one LiDAR frame without a network, the way it is
// usually done: the frame is compared with renderings from all sides, and the best few are refined by
// iterated closest points. The baseline of the evaluation.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/baseline/alignment.hpp"
#include "sim/baseline/signature.hpp"
#include "sim/world/sensor/flash_lidar.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// With the defaults a match takes 0.1..0.2 s on one core of a desktop, and the templates 32 MB.
struct TemplateMatcherSettings {
  int directions = 1000;   // of view, spread evenly over the sphere (1000: 6.5 degrees apart)
  int rolls = 36;          // about the boresight, for each direction; a multiple of 4
  int candidates = 20;     // attitudes that are refined
  int icp_iterations = 8;  // of each candidate; the best few get up to twice as many more
  AlignmentPairs pairs = AlignmentPairs::kRangesAndOutline;
};

class TemplateMatcher {
 public:
  // Renders the templates: about a second. swath_m: side of the square that holds the target at any attitude
  // (sim::swath_m). Throws std::invalid_argument that names the setting which is out of its limits.
  TemplateMatcher(const TriangleMesh& mesh, double swath_m, const TemplateMatcherSettings& settings = {});

  struct Result {
    Eigen::Quaterniond q_lrf_trf = Eigen::Quaterniond::Identity();
    double residual_m = 0.0;  // of ranges and silhouette together (Alignment::residual_m)
    bool valid = false;       // false: too few returns, or no frame of this sensor
  };
  // The target may be off the boresight; returns nearer than gnc::kMinRange_m are the chaser itself.
  // Thread-safe; the same frame gives the same result.
  Result match(const gnc::RangeImage& frame) const;

 private:
  struct Template {
    Signature signature;
    Eigen::Quaterniond q_view_trf;  // view: +y to the centroid of the returns
    Eigen::Vector3d origin_view_m;  // of the TRF, from the point at the mean range on that line
  };
  struct Candidate {
    double difference;
    int entry;          // of templates_
    int quarter_turns;  // by which the frame was rolled to look like it
    int centre;         // of those tried, the one about which it was
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
