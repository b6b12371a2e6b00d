// Instruction sets for which there are inner loops of their own. All give the same bits; they differ in speed
// only. On a target the build decides which exist, on a desktop the processor that is found.
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::gnc {

enum class InstructionSet : std::uint8_t {
  kPortable,    // plain C++, every processor
  k128Bit,      // float32: SSE2 or NEON; fixed point: NEON
  kDotProduct,  // fixed point: Arm's 8-bit dot product
  kDsp,         // fixed point: the dual 16-bit multiply-accumulate of Cortex-M and Cortex-R
  kAvx2,
  kAvxVnni,     // fixed point
  kAvx512,      // float32 and the depth image
  kAvx512Vnni,  // fixed point
};
// Slowest first.
inline constexpr std::array<InstructionSet, 8> kInstructionSets{
    InstructionSet::kPortable, InstructionSet::k128Bit,    InstructionSet::kDotProduct,
    InstructionSet::kDsp,      InstructionSet::kAvx2,      InstructionSet::kAvxVnni,
    InstructionSet::kAvx512,   InstructionSet::kAvx512Vnni};

const char* to_string(InstructionSet set);
// Whether this processor can run a set that this build holds.
bool processor_has(InstructionSet set);

}  // namespace tumblesight::gnc
