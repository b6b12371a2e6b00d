#include "sim/baseline/pose_peer.hpp"

namespace tumblesight::sim {

const std::vector<PosePeerRow>& pose_peers() {
  static const std::vector<PosePeerRow> kPeers {
#if TUMBLESIGHT_HAS_PCL
    {"pcl_fpfh", "PCL: FPFH, RANSAC, ICP", nullptr, make_pcl_registration},
#else
    {"pcl_fpfh", "PCL: FPFH, RANSAC, ICP", "built without PCL: install libpcl-dev, configure and build again",
     nullptr},
#endif
#if TUMBLESIGHT_HAS_OPENCV_PPF
        {"opencv_ppf", "OpenCV: PPF, ICP", nullptr, make_opencv_ppf},
#else
        {"opencv_ppf", "OpenCV: PPF, ICP",
         "built without OpenCV's surface matching: install libopencv-contrib-dev, configure and build again",
         nullptr},
#endif
  };
  return kPeers;
}

}  // namespace tumblesight::sim
