#include "gnc/lidar/depth_loops/plain.hpp"
#include "gnc/lidar/depth_loops/sets.hpp"

const tumblesight::gnc::DepthLoops tumblesight::gnc::depth_loops::kAvx512 = loops_of(InstructionSet::kAvx512);
