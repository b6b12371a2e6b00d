#include "gnc/lidar/depth_loops_plain.hpp"

namespace tumblesight::gnc::depth_loops {

const DepthLoops kAvx512 = make_loops(InstructionSet::kAvx512);

}  // namespace tumblesight::gnc::depth_loops
