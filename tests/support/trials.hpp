// How often a test repeats a trial with other random numbers. The full number runs in the ordinary build. In
// an emulator, under a sanitizer and where branches are counted, trials take 10 to 100 times as long, and
// each shows the same as the others: a fraction of them runs there (TUMBLESIGHT_FEW_TRIALS). Cases that are
// tried one by one are never left out, except bits (kBitStride).
#pragma once

#include <algorithm>
#include <cstddef>

namespace tumblesight {

constexpr int trials(int all) {
  return TUMBLESIGHT_FEW_TRIALS ? std::max(1, all / 8) : all;
}

// The vote is logic on whole words and a CRC sees every change of a bit, so that a bit shows the same as its
// neighbours. With few trials every seventh bit is flipped, which are bits of every significance.
constexpr std::size_t kBitStride = TUMBLESIGHT_FEW_TRIALS ? 7 : 1;

}  // namespace tumblesight
