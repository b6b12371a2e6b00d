// SilhouetteField: distance of every ray of a scan from the silhouette of the target in that scan.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/baseline/target_scan.hpp"

namespace tumblesight::sim {

class SilhouetteField {
 public:
  struct Distance {
    double out_rays;           // signed distance in ray spacings; negative inside the target
    Eigen::Vector2d outwards;  // its gradient, unit vector: right, up
  };

  explicit SilhouetteField(const TargetScan& scan);

  // At `column`, `row` (ray centres at integers). False where the silhouette is not known: outside the frame,
  // and where the nearest edge belongs to an object in front of the target.
  bool at(double column, double row, Distance& distance) const;

 private:
  struct Step {  // offset from a ray to the nearest one on the other side of the silhouette
    int right = 0;
    int down = 0;
    int squared() const { return right * right + down * down; }
  };
  void sweep(std::vector<Step>& steps) const;
  std::vector<Step> nearest(const std::vector<bool>& sought) const;

  int rays_;
  std::vector<Step> steps_;
  std::vector<bool> inside_;
  std::vector<bool> known_;
};

}  // namespace tumblesight::sim
