#include "gnc/nn/kernels.hpp"

#include "gnc/nn/kernels/sets.hpp"

#if TUMBLESIGHT_X86_KERNELS
#include <cpuid.h>
#endif

namespace tumblesight::gnc {
namespace {

template <class N>
using KernelTable = std::array<const Kernels<N>*, kInstructionSets.size()>;

// What this build holds, in the order of InstructionSet.
template <class N>
constexpr KernelTable<N> built();

template <>
constexpr KernelTable<FixedPoint> built<FixedPoint>() {
  KernelTable<FixedPoint> table{&kernels::kFixedPortable};
#if TUMBLESIGHT_X86_KERNELS
  table[static_cast<int>(InstructionSet::kAvx2)] = &kernels::kFixedAvx2;
  table[static_cast<int>(InstructionSet::kAvxVnni)] = &kernels::kFixedAvxVnni;
  table[static_cast<int>(InstructionSet::kAvx512Vnni)] = &kernels::kFixedAvx512Vnni;
#endif
#if TUMBLESIGHT_NEON_KERNELS
  table[static_cast<int>(InstructionSet::k128Bit)] = &kernels::kFixedNeon;
#endif
#if TUMBLESIGHT_DOT_PRODUCT_KERNELS
  table[static_cast<int>(InstructionSet::kDotProduct)] = &kernels::kFixedDotProduct;
#endif
#if TUMBLESIGHT_DSP_KERNELS
  table[static_cast<int>(InstructionSet::kDsp)] = &kernels::kFixedDsp;
#endif
  return table;
}

#if TUMBLESIGHT_FLOAT32
template <>
constexpr KernelTable<Float32> built<Float32>() {
  KernelTable<Float32> table{&kernels::kFloatPortable};
#if TUMBLESIGHT_X86_KERNELS
  table[static_cast<int>(InstructionSet::k128Bit)] = &kernels::kFloat128Bit;
  table[static_cast<int>(InstructionSet::kAvx2)] = &kernels::kFloatAvx2;
  table[static_cast<int>(InstructionSet::kAvx512)] = &kernels::kFloatAvx512;
#elif TUMBLESIGHT_NEON_KERNELS
  table[static_cast<int>(InstructionSet::k128Bit)] = &kernels::kFloat128Bit;
#endif
  return table;
}
#endif

#if TUMBLESIGHT_X86_KERNELS
// Leaf 7, subleaf 1, EAX bit 4. clang 14's __builtin_cpu_supports does not know its name. AVX2 tells that the
// operating system keeps the registers.
bool has_avx_vnni() {
  unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
  return __get_cpuid_count(7, 1, &eax, &ebx, &ecx, &edx) != 0 && (eax & (1U << 4)) != 0 &&
         __builtin_cpu_supports("avx2") != 0;
}
#endif

bool processor_has(InstructionSet set) {
#if TUMBLESIGHT_X86_KERNELS
  switch (set) {
    case InstructionSet::kAvx2:
      return __builtin_cpu_supports("avx2") != 0;
    case InstructionSet::kAvxVnni:
      return has_avx_vnni();
    case InstructionSet::kAvx512:
      return __builtin_cpu_supports("avx512f") != 0;
    case InstructionSet::kAvx512Vnni:
      return __builtin_cpu_supports("avx512vnni") != 0 && __builtin_cpu_supports("avx512bw") != 0;
    default:
      return true;
  }
#else
  (void)set;
  return true;  // the build knows its processor
#endif
}

}  // namespace

const char* to_string(InstructionSet set) {
  switch (set) {
    case InstructionSet::kPortable:
      return "portable";
    case InstructionSet::k128Bit:
      return TUMBLESIGHT_NEON_KERNELS ? "neon" : "sse2";
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

template <class N>
const Kernels<N>* kernels_on(InstructionSet set) {
  static constexpr KernelTable<N> kBuilt = built<N>();
  const Kernels<N>* const found = kBuilt[static_cast<std::size_t>(set)];
  return found != nullptr && processor_has(set) ? found : nullptr;
}

template <class N>
const Kernels<N>& fastest_kernels() {
  const Kernels<N>* fastest = kernels_on<N>(InstructionSet::kPortable);
  for (const InstructionSet set : kInstructionSets) {  // slowest first
    const Kernels<N>* const found = kernels_on<N>(set);
    fastest = found != nullptr ? found : fastest;
  }
  return *fastest;
}

template const Kernels<FixedPoint>* kernels_on(InstructionSet);
template const Kernels<FixedPoint>& fastest_kernels();
#if TUMBLESIGHT_FLOAT32
template const Kernels<Float32>* kernels_on(InstructionSet);
template const Kernels<Float32>& fastest_kernels();
#endif

}  // namespace tumblesight::gnc
