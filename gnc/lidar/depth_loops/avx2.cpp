#include "gnc/lidar/depth_loops/plain.hpp"
#include "gnc/lidar/depth_loops/sets.hpp"

namespace tumblesight::gnc::depth_loops {

const DepthLoops kAvx2 = loops_of(InstructionSet::kAvx2);

}  // namespace tumblesight::gnc::depth_loops
