// The sets that exist, one source file each. Which of them a build holds: CMakeLists.txt.
#pragma once

#include "gnc/lidar/depth_loops.hpp"

namespace tumblesight::gnc::depth_loops {

extern const DepthLoops kPortable, kAvx2, kAvx512;

}  // namespace tumblesight::gnc::depth_loops
