#include "gnc/lidar/depth_loops/plain.hpp"
#include "gnc/lidar/depth_loops/sets.hpp"

namespace tumblesight::gnc::depth_loops {

const DepthLoops kAvx512 = loops_of(InstructionSet::kAvx512);

}  // namespace tumblesight::gnc::depth_loops
