#include "gnc/lidar/depth_loops.hpp"

namespace tumblesight::gnc {

const DepthLoops& fastest_depth_loops(InstructionSet set) {
  const DepthLoops* fastest = &depth_loops::kPortable;
#if TUMBLESIGHT_X86_KERNELS
  for (const DepthLoops* const loops : {&depth_loops::kAvx2, &depth_loops::kAvx512}) {
    if (loops->set <= set && processor_has(loops->set)) fastest = loops;
  }
#else
  (void)set;
#endif
  return *fastest;
}

}  // namespace tumblesight::gnc
