#include "gnc/numerics/instruction_set.hpp"

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace tumblesight::gnc {

const char* to_string(InstructionSet set) {
  switch (set) {
    case InstructionSet::kPortable:
      return "portable";
    case InstructionSet::k128Bit:
#if defined(__ARM_NEON)
      return "neon";
#else
      return "sse2";
#endif
    case InstructionSet::kDotProduct:
      return "neon-dotprod";
    case InstructionSet::kDsp:
      return "arm-dsp";
    case InstructionSet::kAvx2:
      return "avx2";
    case InstructionSet::kAvxVnni:
      return "avx-vnni";
    case InstructionSet::kAvx512:
      return "avx512";
    case InstructionSet::kAvx512Vnni:
      return "avx512-vnni";
  }
  return "unknown";
}

#if defined(__x86_64__)
namespace {

// CPUID leaf 7, subleaf 1, EAX bit 4: clang 14's __builtin_cpu_supports does not know the name. The check for
// AVX2 makes sure that the operating system saves the vector registers.
bool has_avx_vnni() {
  unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
  return __get_cpuid_count(7, 1, &eax, &ebx, &ecx, &edx) != 0 && (eax & (1U << 4)) != 0 &&
         __builtin_cpu_supports("avx2") != 0;
}

// AVX-512F with the extensions that the kernels use and that nearly every such processor has.
bool has_avx512() {
  return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
         __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512vl") != 0;
}

}  // namespace

bool processor_has(InstructionSet set) {
  switch (set) {
    case InstructionSet::kPortable:
    case InstructionSet::k128Bit:      // SSE2: part of x86-64
    case InstructionSet::kDotProduct:  // not in x86 builds
    case InstructionSet::kDsp:
      return true;
    case InstructionSet::kAvx2:
      return __builtin_cpu_supports("avx2") != 0;
    case InstructionSet::kAvxVnni:
      return has_avx_vnni();
    case InstructionSet::kAvx512:
      return has_avx512();
    case InstructionSet::kAvx512Vnni:
      return has_avx512() && __builtin_cpu_supports("avx512vnni") != 0;
  }
  return false;
}
#else
bool processor_has(InstructionSet) {
  return true;  // the build contains only what its target processor has
}
#endif

}  // namespace tumblesight::gnc
