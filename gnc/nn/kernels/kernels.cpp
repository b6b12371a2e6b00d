#include "gnc/nn/kernels/kernels.hpp"

#include "gnc/nn/kernels/sets.hpp"

namespace tumblesight::gnc {
namespace {

template <class N>
using KernelTable = std::array<const Kernels<N>*, kInstructionSets.size()>;

// The kernels that this build contains, in the order of InstructionSet.
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

}  // namespace

template <class N>
const Kernels<N>* kernels_on(InstructionSet set) {
  static constexpr KernelTable<N> kBuilt = built<N>();
  const Kernels<N>* const found = kBuilt[static_cast<std::size_t>(set)];
  return found != nullptr && processor_has(set) ? found : nullptr;
}

template <class N>
const Kernels<N>& fastest_kernels() {
  const Kernels<N>* fastest = kernels_on<N>(InstructionSet::kPortable);
  for (const InstructionSet set : kInstructionSets) {  // in ascending order of speed
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
