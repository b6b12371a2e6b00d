// PclSearch: what PCL itself does for pcl_registration.cpp. A library of its own, because Debian's PCL needs
// Eigen's types with the alignment of vector instructions, and the rest of the project is built without. So
// no type of Eigen may cross this interface.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace tumblesight::sim {

// x, y, z of the points, one after the other, in metres, and of their unit normals.
struct PclPoints {
  std::vector<float> points_m;
  std::vector<float> normals;
};

struct PclSettings {
  double feature_radius_m;  // of the surface that a feature describes
  int iterations;           // of RANSAC
  int samples;              // points of the scan per iteration
  int similar_features;     // among which RANSAC draws the partner of a point
  float similarity;         // of the polygons of samples and partners, 0 to 1
  double inlier_m;
  float inlier_share;  // of the scan; a pose with fewer inliers is none
  double icp_pair_m;
  int icp_iterations;
};

using PclPose = std::array<float, 16>;  // 4 x 4, row by row: scan to model

class __attribute__((visibility("default"))) PclSearch {
 public:
  // `coarse` has the features, `fine` is for ICP.
  PclSearch(const PclPoints& coarse, const PclPoints& fine, const PclSettings& settings);
  ~PclSearch();
  PclSearch(PclSearch&&) noexcept;
  PclSearch& operator=(PclSearch&&) noexcept;

  // A scan and its features, which do not depend on the model.
  class Scan;
  static std::shared_ptr<const Scan> prepared(const PclPoints& scan, const PclSettings& settings);

  // None if no pose has enough inliers. Draws from std::rand().
  std::optional<PclPose> ransac(const std::shared_ptr<const Scan>& scan) const;
  PclPose icp(const std::shared_ptr<const Scan>& scan, const PclPose& start) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace tumblesight::sim
