// The kernels that exist, one source file a set. Which of them a build holds: CMakeLists.txt.
#pragma once

#include "gnc/nn/kernels.hpp"

namespace tumblesight::gnc::kernels {

extern const Kernels<FixedPoint> kFixedPortable, kFixedNeon, kFixedDotProduct, kFixedDsp, kFixedAvx2,
    kFixedAvxVnni, kFixedAvx512Vnni;
extern const Kernels<Float32> kFloatPortable, kFloat128Bit, kFloatAvx2, kFloatAvx512;

}  // namespace tumblesight::gnc::kernels
