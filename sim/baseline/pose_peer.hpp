// PosePeer: another library's way to the attitude of a known target from one LiDAR frame, with what that
// library itself offers. The evaluation runs it on the same frames as template matching.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

class PosePeer {
 public:
  struct Result {
    Eigen::Quaterniond q_lrf_trf = Eigen::Quaterniond::Identity();
    bool valid = false;  // false: too few returns, or no pose was found
  };
  virtual ~PosePeer() = default;
  // Uses one thread. The same frame gives the same result. These libraries draw from the random numbers of
  // the C library, so only one peer of a process may match at a time.
  virtual Result match(const gnc::RangeImage& frame) const = 0;
};

struct PosePeerRow {
  const char* key;      // in CSV and JSON: a-z, 0-9 and _
  const char* name;     // in tables
  const char* missing;  // why this build is without it, and the remedy; nullptr: it is there
  // `swath_m`: side of the square that holds the target at any attitude (sim::swath_m). Takes up to some
  // seconds. nullptr: this build is without it.
  std::unique_ptr<PosePeer> (*make)(const TriangleMesh& mesh, double swath_m);
};

// Every peer, also those that this build is without.
const std::vector<PosePeerRow>& pose_peers();

std::unique_ptr<PosePeer> make_pcl_registration(const TriangleMesh& mesh, double swath_m);
std::unique_ptr<PosePeer> make_opencv_ppf(const TriangleMesh& mesh, double swath_m);

}  // namespace tumblesight::sim
