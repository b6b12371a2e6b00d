// How often a test repeats a trial with other random numbers. The full number runs in the ordinary build. In
// an emulator, under a sanitizer and where branches are counted, trials take 10 to 100 times as long, and
// each shows the same as the others: a fraction of them runs there (TUMBLESIGHT_FEW_TRIALS). Cases that are
// tried one by one, such as every bit, are never left out.
#pragma once

#include <algorithm>

namespace tumblesight {

constexpr int trials(int all) {
  return TUMBLESIGHT_FEW_TRIALS ? std::max(1, all / 8) : all;
}

}  // namespace tumblesight
