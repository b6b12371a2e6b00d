#include "gnc/lidar/depth_loops/plain.hpp"
#include "gnc/lidar/depth_loops/sets.hpp"

namespace tumblesight::gnc::depth_loops {

const DepthLoops kPortable = loops_of(InstructionSet::kPortable);

}  // namespace tumblesight::gnc::depth_loops
