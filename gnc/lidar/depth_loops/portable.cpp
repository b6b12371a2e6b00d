#include "gnc/lidar/depth_loops/plain.hpp"
#include "gnc/lidar/depth_loops/sets.hpp"

const tumblesight::gnc::DepthLoops tumblesight::gnc::depth_loops::kPortable = loops_of(InstructionSet::kPortable);
