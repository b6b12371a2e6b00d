// All tables of depth loops, one source file per instruction set. The CMakeLists.txt of this folder decides
// which of them a build contains.
#pragma once

#include "gnc/lidar/depth_loops.hpp"

namespace tumblesight::gnc::depth_loops {

extern const DepthLoops kPortable, kAvx2, kAvx512;

}  // namespace tumblesight::gnc::depth_loops
