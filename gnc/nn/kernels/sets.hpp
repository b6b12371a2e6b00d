// All tables of kernels, one source file per instruction set. The CMakeLists.txt of this folder decides which
// of them a build contains.
#pragma once

#include "gnc/nn/kernels/kernels.hpp"

namespace tumblesight::gnc::kernels {

extern const Kernels<FixedPoint> kFixedPortable, kFixedNeon, kFixedDotProduct, kFixedDsp, kFixedAvx2,
    kFixedAvxVnni, kFixedAvx512Vnni;
extern const Kernels<Float32> kFloatPortable, kFloat128Bit, kFloatAvx2, kFloatAvx512;

}  // namespace tumblesight::gnc::kernels
