// Instruction sets for which the library has optimized inner loops. All of them compute the same bits; only
// the speed differs. On a target processor the compiler flags decide which ones exist; on a desktop the
// program detects at start-up which ones the processor has.
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::gnc {

enum class InstructionSet : std::uint8_t {
  kPortable,    // plain C++, for every processor
  k128Bit,      // float32: SSE2 or NEON; fixed point: NEON
  kDotProduct,  // fixed point: 8-bit dot product of ARMv8.2
  kDsp,         // fixed point: dual 16-bit multiply-accumulate of Cortex-M and Cortex-R
  kAvx2,
  kAvxVnni,     // fixed point
  kAvx512,      // float32 and the depth image
  kAvx512Vnni,  // fixed point
};
// In ascending order of speed.
inline constexpr std::array<InstructionSet, 8> kInstructionSets{
    InstructionSet::kPortable, InstructionSet::k128Bit,    InstructionSet::kDotProduct,
    InstructionSet::kDsp,      InstructionSet::kAvx2,      InstructionSet::kAvxVnni,
    InstructionSet::kAvx512,   InstructionSet::kAvx512Vnni};

// Lower-case name for logs and options, such as "avx512-vnni"; "unknown" for a value outside the enumeration.
const char* to_string(InstructionSet set);
// Whether this processor can run `set`. Answers only for sets that this build contains.
bool processor_has(InstructionSet set);

}  // namespace tumblesight::gnc
