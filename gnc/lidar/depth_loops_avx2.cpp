#include "gnc/lidar/depth_loops_plain.hpp"

namespace tumblesight::gnc::depth_loops {

const DepthLoops kAvx2 = make_loops(InstructionSet::kAvx2);

}  // namespace tumblesight::gnc::depth_loops
