// One channel at a time: for processors without vectors, and for channels that do not fill a vector.
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
