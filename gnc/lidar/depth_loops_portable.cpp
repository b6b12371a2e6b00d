#include "gnc/lidar/depth_loops_plain.hpp"

namespace tumblesight::gnc::depth_loops {

const DepthLoops kPortable = make_loops(InstructionSet::kPortable);

}  // namespace tumblesight::gnc::depth_loops
