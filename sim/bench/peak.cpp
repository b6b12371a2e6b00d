#include "sim/bench/peak.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace tumblesight::sim {
namespace {

constexpr std::uint64_t kRounds = 10'000;
constexpr int kTries = 500;  // the fastest one counts, since the others may have been interrupted

double macs_per_second(const peak::Chains& chains) {
  double best_s = 1e9;
  for (int i = 0; i < kTries; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    chains.run(kRounds);
    best_s =
        std::min(best_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return static_cast<double>(kRounds) * chains.macs_per_round / best_s;
}

}  // namespace

std::optional<double> measured_peak_macs(gnc::InstructionSet set, bool is_integer) {
  using gnc::InstructionSet;
  const peak::Chains* chains = nullptr;
#if TUMBLESIGHT_X86_KERNELS
  if (is_integer) {
    if (set == InstructionSet::kAvx2) chains = &peak::kFixedAvx2;
    if (set == InstructionSet::kAvxVnni) chains = &peak::kFixedAvxVnni;
    if (set == InstructionSet::kAvx512Vnni) chains = &peak::kFixedAvx512Vnni;
  } else {
    if (set == InstructionSet::k128Bit) chains = &peak::kFloatSse2;
    if (set == InstructionSet::kAvx2) chains = &peak::kFloatAvx2;
    if (set == InstructionSet::kAvx512) chains = &peak::kFloatAvx512;
  }
#else
  (void)is_integer;
#endif
  if (chains == nullptr || !gnc::processor_has(set)) return std::nullopt;
  return macs_per_second(*chains);
}

}  // namespace tumblesight::sim
