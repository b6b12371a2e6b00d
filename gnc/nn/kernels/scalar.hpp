// One channel at a time: what every processor can do, and what is left over where vectors do not fit.
#pragma once

#include "gnc/nn/kernels/blocks.hpp"

namespace tumblesight::gnc {
namespace {

template <class AnyKind>
struct Scalar {
  using Kind = AnyKind;
  static constexpr int kWidth = 1;
  using Sums = typename Kind::Sum;
  using Weights = const typename Kind::Weight*;
  using Values = const typename Kind::Input*;
  TUMBLESIGHT_INLINE Sums load(const Sums* from) { return *from; }
  TUMBLESIGHT_INLINE void store(Sums sum, Sums* to) { *to = sum; }
  TUMBLESIGHT_INLINE Weights weights(Weights from) { return from; }
  TUMBLESIGHT_INLINE Values values(Values from) { return from; }
  TUMBLESIGHT_INLINE void add(Sums& sum, Values value, Weights weight) {
#pragma GCC unroll 4
    for (int i = 0; i < Kind::kGroup; ++i) sum += static_cast<Sums>(value[i]) * static_cast<Sums>(weight[i]);
  }
};

}  // namespace
}  // namespace tumblesight::gnc
