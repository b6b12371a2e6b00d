#include "gnc/lidar/target_selection.hpp"

#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {
namespace {

using Scratch = TargetSelectionScratch;
using Word = std::uint32_t;

constexpr int kWords = RayMask::kWordsPerRow;
constexpr int kBins = Scratch::kBins;
constexpr int kBinBits = 7;  // 2^7 counts per bin: one metre
static_assert(kCountsPerMetre == 1 << kBinBits);

// Returns needed for a well filled slice: kMinReturns, this many times those of the median slice (what is
// spread evenly over the ranges is not the target), and this share of those of the fullest slice.
constexpr int kTimesMedian = 4;
constexpr int kFullestOverFilled = 64;
// Of a target's returns at least this share is like the next ray of the row; of scattered ones hardly any.
constexpr int kReturnsOverPairs = 16;
// A slice goes on bin by bin while the next one holds this share of the returns of the one before, and at
// least kFilled of them: ranges that are noisier than the paper's fall off slowly, and clean ones at once.
constexpr int kGoesOnNumerator = 3, kGoesOnDenominator = 8;
constexpr int kFilled = 4;
constexpr int kMostMoreBins = 32;  // to either side

// A block with this many chosen rays belongs to a surface.
constexpr int kRaysOfSurface = 8;
// Fewer isolated returns than this are no clutter.
constexpr int kMinIsolated = 16;
// The neighbours needed are at most a quarter of the support that the median return has: many on a surface,
// few on a target that reflects few rays.
constexpr int kSupportOverNeeded = 4;

constexpr int kSweeps = 4;

// A range of bins: [first, first + count).
struct Slice {
  int first;
  int count;
};

// As deep as the target and four standard deviations of the range noise (0.1 m + 1 % of the range: the
// paper's sensor), in whole bins, and one more for where it begins within its first bin.
int bins_of_slice(int first_bin, std::uint32_t target_radius_mm) {
  const std::uint32_t depth_mm =
      2 * target_radius_mm + 4 * (100 + 10 * static_cast<std::uint32_t>(first_bin));
  return static_cast<int>((depth_mm * 131) >> 17) + 2;  // 131 / 2^17 = 1 / 1000.5
}

// The sums of the bins before each bin. Leaves out the bins that are not used.
void sum_up(Scratch::Counts& counts) {
  for (int bin = 0; bin < kMinRange_m; ++bin) counts[bin + 1] = 0;
  for (int bin = kMaxRange_m + 1; bin < kBins; ++bin) counts[bin + 1] = 0;
  for (int bin = 1; bin <= kBins; ++bin)
    counts[bin] = static_cast<std::uint16_t>(counts[bin] + counts[bin - 1]);
}

void count_bins(const RangeImage& frame, int largest_step, Scratch& scratch) {
  auto& returns = scratch.returns_before;
  auto& pairs = scratch.pairs_before;
  returns.fill(0);
  pairs.fill(0);
  for (int row = 0; row < frame.rays; ++row) {
    const std::uint16_t* const ranges = frame.ranges.data() + row * frame.rays;
    int next = 0;  // the last ray of a row has none
    for (int column = frame.rays - 1; column >= 0; --column) {
      // A range beyond the gate counts as no return, also within the last bin.
      const int range = ranges[column] & sign_mask(ranges[column] - kMaxRange_counts - 1);
      const int is_pair = sign_mask(abs(range - next) - largest_step - 1) & 1;
      const int bin = (range >> kBinBits) + 1;
      ++returns[bin];
      pairs[bin] = static_cast<std::uint16_t>(pairs[bin] + is_pair);
      next = range;
    }
  }
  for (int bin = 0; bin < kMinRange_m; ++bin) scratch.near_returns[bin] = returns[bin + 1];
  sum_up(returns);
  sum_up(pairs);
}

void count_slices(std::uint32_t target_radius_mm, Scratch& scratch) {
  for (int bin = 0; bin < kBins; ++bin) {
    const int end = min_small(bin + bins_of_slice(bin, target_radius_mm), kBins);
    scratch.returns_in_slice[bin] =
        static_cast<std::uint16_t>(scratch.returns_before[end] - scratch.returns_before[bin]);
  }
}

// The median of the slices' returns, by bisection.
int median_of_slices(const Scratch& scratch) {
  int median = 0;
  for (int bit = 1 << 13; bit > 0; bit >>= 1) {
    int below = 0;
    for (const std::uint16_t returns : scratch.returns_in_slice) below -= sign_mask(returns - (median + bit));
    median += bit & ~sign_mask(kBins / 2 - below);
  }
  return median;
}

// The first slice with as many returns as needed, which must not be scattered ones if `with_pairs` is set;
// kBins if there is none.
int first_filled_slice(const Scratch& scratch, int needed, int with_pairs, std::uint32_t target_radius_mm) {
  int first = kBins;
  for (int bin = kBins - 1; bin >= 0; --bin) {
    const int end = min_small(bin + bins_of_slice(bin, target_radius_mm), kBins);
    const int returns = scratch.returns_in_slice[bin];
    const int pairs = scratch.pairs_before[end] - scratch.pairs_before[bin];
    const int is_scattered = sign_mask(kReturnsOverPairs * pairs - returns) & with_pairs;
    first += (bin - first) & ~sign_mask(returns - needed) & ~is_scattered;
  }
  return first;
}

int returns_of_bin(const Scratch& scratch, int bin) {
  return scratch.returns_before[bin + 1] - scratch.returns_before[bin];
}

// The last bin to which a slice goes on from `edge`, its outermost bin, by `step`: 1 or -1. `count`: bins of
// the slice, 0 for none; it grows by no more than these to either side.
int goes_on_to(const Scratch& scratch, int edge, int step, int count, int median) {
  int bin = edge;
  const int inner = min_small(max_small(edge - step, 0), kBins - 1);
  int before = max_small(returns_of_bin(scratch, edge), returns_of_bin(scratch, inner));
  int goes_on = -1;
  for (int more = 0; more < kMostMoreBins; ++more) {
    const int next = min_small(max_small(bin + step, 0), kBins - 1);
    const int returns = returns_of_bin(scratch, next);
    const int falls_off = sign_mask(kGoesOnDenominator * returns - kGoesOnNumerator * before);
    const int is_clutter = sign_mask(returns * count - kTimesMedian * median);
    goes_on &= sign_mask(more - count) & ~falls_off & ~is_clutter & ~sign_mask(returns - kFilled);
    bin += (next - bin) & goes_on;
    before = returns;
  }
  return bin;
}

// The slice and the bins to which a noisy target goes on.
Slice with_tails(const Scratch& scratch, Slice slice, int median) {
  const int end = min_small(max_small(slice.first + slice.count, 1), kBins);
  const int last = goes_on_to(scratch, end - 1, 1, slice.count, median);
  const int first = goes_on_to(scratch, slice.first, -1, slice.count, median);
  return {first, (last + 1 - first) & sign_mask(-slice.count)};
}

// Of the slices that begin within the first well filled one, the one with the most returns. Its count is 0 if
// no slice is well filled.
Slice nearest_filled_slice(const Scratch& scratch, int median, std::uint32_t target_radius_mm) {
  int fullest = 0;
  for (const std::uint16_t returns : scratch.returns_in_slice) fullest = max_small(fullest, returns);
  const int needed = max(max(kMinReturns, kTimesMedian * median), fullest / kFullestOverFilled);

  // A target that reflects few rays may have no pairs.
  const int with_pairs = first_filled_slice(scratch, needed, -1, target_radius_mm);
  const int any = first_filled_slice(scratch, needed, 0, target_radius_mm);
  const int nearest = with_pairs + ((any - with_pairs) & ~sign_mask(with_pairs - kBins));
  const int last = nearest + bins_of_slice(nearest, target_radius_mm);
  int best = 0, most = 0;
  for (int bin = 0; bin < kBins; ++bin) {
    const int returns = scratch.returns_in_slice[bin];
    const int better = sign_mask(most - returns) & ~sign_mask(bin - nearest) & sign_mask(bin - last);
    most += (returns - most) & better;
    best += (bin - best) & better;
  }
  return {best, bins_of_slice(best, target_radius_mm) & sign_mask(nearest - kBins)};
}

// Counts from which a slice takes returns: kMinRange_counts or its own begin. A target that fills the bins on
// both sides of kMinRange_m goes on nearer, bin by bin, until it is as deep as its slice.
int begin_of(const Scratch& scratch, Slice slice) {
  const auto is_filled = [&scratch](int bin) {
    const int returns = bin < kMinRange_m ? scratch.near_returns[bin] : returns_of_bin(scratch, bin);
    return ~sign_mask(returns - kFilled);
  };
  int deepest = 0;  // filled bin of the slice
  for (int bin = kMinRange_m; bin < kBins; ++bin)
    deepest += (bin - deepest) & is_filled(bin) & sign_mask(bin - slice.first - slice.count);
  int goes_on = is_filled(kMinRange_m) & sign_mask(slice.first - kMinRange_m - 1);
  int begin = max(slice.first, kMinRange_m);
  for (int bin = kMinRange_m - 1; bin > 0; --bin) {
    goes_on &= is_filled(bin) & sign_mask(deepest - slice.count - bin);
    begin += goes_on;  // -1 or 0
  }
  return begin << kBinBits;
}

// The frame's rays of one word of a mask: one bit for each range in [from, end).
Word chosen(const std::uint16_t* ranges, int columns, int from, int end) {
  Word bits = 0;
  for (int i = 0; i < columns; ++i)
    bits = 2 * bits + (static_cast<Word>((ranges[i] - end) & ~(ranges[i] - from)) >> 31);
  return bits;
}

void choose_slice(const RangeImage& frame, const Scratch& scratch, Slice slice, RayMask& mask) {
  constexpr int kColumns = RayMask::kColumnsPerWord;
  const int from = begin_of(scratch, slice);
  const int end = min((slice.first + slice.count) << kBinBits, kMaxRange_counts + 1);
  mask = {};
  for (int row = 0; row < frame.rays; ++row) {
    const std::uint16_t* const ranges = frame.ranges.data() + row * frame.rays;
    int first = 0;
    for (; first + kColumns <= frame.rays; first += kColumns)
      mask.rows[row][first / kColumns] = chosen(ranges + first, kColumns, from, end);
    const int left = frame.rays - first;
    if (left > 0)
      mask.rows[row][first / kColumns] = chosen(ranges + first, left, from, end) << (kColumns - left);
  }
}

// A number from 0 to 7 for each of 32 rays: bit k of all numbers in one word.
struct Three {
  Word one, two, four;
};

// How many of five bits are set.
Three sum_of(Word a, Word b, Word c, Word d, Word e) {
  const Word ab = a ^ b, abc = ab ^ c;
  const Word first = (a & b) | (ab & c);
  const Word abcd = abc ^ d;
  const Word second = (abc & d) | (abcd & e);
  return {abcd ^ e, first ^ second, first & second};
}

// The sum of the bits of a ray and of the two rays on either side.
Three sum_across(const std::array<Word, kWords + 2>& row, int word) {
  const Word left = row[word], here = row[word + 1], right = row[word + 2];
  return sum_of((here >> 2) | (left << 30), (here >> 1) | (left << 31), here, (here << 1) | (right >> 31),
                (here << 2) | (right >> 30));
}

// The sums of the 5 x 5 bits around the rays of a row.
void count_support(const RayMask& mask, int row, Scratch& scratch) {
  static constexpr RayMask::Row kNone{};
  const auto row_at = [&mask](int other) -> const RayMask::Row& {
    return other < 0 || other >= RangeImage::kMaxRays ? kNone : mask.rows[other];
  };
  const RayMask::Row &a = row_at(row - 2), &b = row_at(row - 1), &c = row_at(row), &d = row_at(row + 1),
                     &e = row_at(row + 2);
  std::array<std::array<Word, kWords + 2>, 3> down{};  // sums of five rows, bit by bit, with a margin
  for (int word = 0; word < kWords; ++word) {
    const Three sum = sum_of(a[word], b[word], c[word], d[word], e[word]);
    down[0][word + 1] = sum.one;
    down[1][word + 1] = sum.two;
    down[2][word + 1] = sum.four;
  }
  for (int word = 0; word < kWords; ++word) {
    const Three ones = sum_across(down[0], word);
    const Three twos = sum_across(down[1], word);
    const Three fours = sum_across(down[2], word);
    const Three of_two = sum_of(ones.two, twos.one, 0, 0, 0);
    const Three of_four = sum_of(ones.four, twos.two, fours.one, of_two.two, 0);
    const Three of_eight = sum_of(twos.four, fours.two, of_four.two, 0, 0);
    scratch.support[0].rows[row][word] = ones.one;
    scratch.support[1].rows[row][word] = of_two.one;
    scratch.support[2].rows[row][word] = of_four.one;
    scratch.support[3].rows[row][word] = of_eight.one;
    // The sum is at most 25, so that at most one of these is set.
    scratch.support[4].rows[row][word] = fours.four | of_four.four | of_eight.two;
  }
}

// The rays of a word with a support of at least `least`.
Word with_support(const Scratch& scratch, int row, int word, int least) {
  Word enough = ~Word{0};
  for (int bit = 0; bit < Scratch::kSupportBits; ++bit) {
    const Word support = scratch.support[bit].rows[row][word];
    const auto needed = static_cast<Word>(-((least >> bit) & 1));
    enough = (support & (enough | ~needed)) | (enough & ~needed);
  }
  return enough;
}

// Of the rays of `mask`, how many have a support of at least `least`.
int count_with_support(const RayMask& mask, const Scratch& scratch, int rows, int least) {
  int count = 0;
  for (int row = 0; row < rows; ++row)
    for (int word = 0; word < kWords; ++word)
      count += count_ones(mask.rows[row][word] & with_support(scratch, row, word, least));
  return count;
}

// The largest multiple of kSupportOverNeeded that at least half of the chosen rays have as support, over
// kSupportOverNeeded.
int most_neighbours_needed(const RayMask& mask, const Scratch& scratch, int rows) {
  const int chosen = count_with_support(mask, scratch, rows, 0);
  int support = 0;
  for (int bit = 1 << (Scratch::kSupportBits - 1); bit >= kSupportOverNeeded; bit >>= 1) {
    const int with = count_with_support(mask, scratch, rows, support + bit);
    support += bit & ~sign_mask(2 * with - chosen);
  }
  return support / kSupportOverNeeded;
}

constexpr int block_at(int row, int column) {
  return (row + 1) * Scratch::kStride + column + 1;
}

// The chosen rays of each block.
void count_blocks(const RayMask& mask, Scratch& scratch) {
  constexpr int kBlocksPerWord = RayMask::kColumnsPerWord / Scratch::kBlockRays;
  scratch.returns_of_block.fill(0);
  for (int row = 0; row < Scratch::kBlocks; ++row) {
    for (int word = 0; word < kWords; ++word) {
      Word even = 0, odd = 0;  // sums of blocks 0, 2, 4, 6 and 1, 3, 5, 7; eight bits each
      for (int i = 0; i < Scratch::kBlockRays; ++i) {
        Word bits = mask.rows[Scratch::kBlockRays * row + i][word];
        bits -= (bits >> 1) & 0x5555'5555U;
        bits = (bits & 0x3333'3333U) + ((bits >> 2) & 0x3333'3333U);
        even += (bits >> 4) & 0x0F0F'0F0FU;
        odd += bits & 0x0F0F'0F0FU;
      }
      std::uint16_t* const returns = &scratch.returns_of_block[block_at(row, kBlocksPerWord * word)];
      for (int pair = 0; pair < kBlocksPerWord / 2; ++pair) {
        returns[2 * pair] = static_cast<std::uint16_t>((even >> (24 - 8 * pair)) & 0xFF);
        returns[2 * pair + 1] = static_cast<std::uint16_t>((odd >> (24 - 8 * pair)) & 0xFF);
      }
    }
  }
}

// One bit per block; block 0 is the highest.
using BlockRow = Word;
using BlockMask = std::array<BlockRow, Scratch::kBlocks>;

// The rays of the eight blocks of one word of a mask.
Word rays_of(BlockRow blocks, int word) {
  Word bits = (blocks >> (24 - 8 * word)) & 0xFF;
  bits = (bits | (bits << 12)) & 0x000F'000FU;
  bits = (bits | (bits << 6)) & 0x0303'0303U;
  bits = (bits | (bits << 3)) & 0x1111'1111U;
  return (bits << 4) - bits;
}

// The blocks of surfaces and the blocks around those.
BlockMask find_surfaces(const Scratch& scratch) {
  BlockMask surfaces{};
  for (int row = 0; row < Scratch::kBlocks; ++row) {
    BlockRow bits = 0;
    for (int column = 0; column < Scratch::kBlocks; ++column) {
      const int returns = scratch.returns_of_block[block_at(row, column)];
      bits = 2 * bits + static_cast<BlockRow>(~sign_mask(returns - kRaysOfSurface) & 1);
    }
    surfaces[row] = bits | (bits << 1) | (bits >> 1);
  }
  BlockMask around{};
  for (int row = 0; row < Scratch::kBlocks; ++row) {
    const BlockRow above = row == 0 ? 0 : surfaces[row - 1];
    const BlockRow below = row == Scratch::kBlocks - 1 ? 0 : surfaces[row + 1];
    around[row] = surfaces[row] | above | below;
  }
  return around;
}

// How many neighbours a return needs. Clutter that is spread over the image at random has a Poisson
// distribution: of its returns, (mean number of neighbours) times as many have one neighbour as have none.
int neighbours_needed(const RayMask& mask, const Scratch& scratch, int rows) {
  const BlockMask surfaces = find_surfaces(scratch);
  int alone = 0, with_one = 0;
  for (int row = 0; row < rows; ++row) {
    for (int word = 0; word < kWords; ++word) {
      const Word away = mask.rows[row][word] & ~rays_of(surfaces[row / Scratch::kBlockRays], word);
      const Word two_or_more = away & with_support(scratch, row, word, 2);
      alone += count_ones(away & ~two_or_more);
      with_one += count_ones(two_or_more & ~with_support(scratch, row, word, 3));
    }
  }
  const auto above_tenths = [alone, with_one](int tenths) {
    return ~sign_mask(10 * with_one - tenths * alone) & 1;
  };
  const int needed = 2 + above_tenths(3) + above_tenths(7) + above_tenths(12);
  return min_small(needed, most_neighbours_needed(mask, scratch, rows)) & ~sign_mask(alone - kMinIsolated);
}

void drop_unsupported(const Scratch& scratch, int rows, int needed, RayMask& mask) {
  for (int row = 0; row < rows; ++row)
    for (int word = 0; word < kWords; ++word)
      mask.rows[row][word] &= with_support(scratch, row, word, needed + 1);
}

constexpr int kNoPart = 0xFFFF;  // of an empty block

// The smallest number of the block and of four neighbours that were visited before.
inline void join(Scratch& scratch, int block, int to_previous) {
  constexpr int kStride = Scratch::kStride;
  std::uint16_t* const part = &scratch.part_of_block[block];
  const int beside = min_small(part[to_previous], part[to_previous * kStride]);
  const int corners = min_small(part[to_previous * (kStride - 1)], part[to_previous * (kStride + 1)]);
  const int is_empty = sign_mask(kNoPart - 1 - *part);
  *part = static_cast<std::uint16_t>(min_small(*part, min_small(beside, corners)) | is_empty);
}

// Gives connected blocks the same number. A part that winds more often than there are sweeps may get several.
void number_parts(Scratch& scratch) {
  constexpr int kFirst = block_at(0, 0), kLast = block_at(Scratch::kBlocks - 1, Scratch::kBlocks - 1);
  for (int block = 0; block < Scratch::kAllBlocks; ++block)
    scratch.part_of_block[block] =
        static_cast<std::uint16_t>(block | sign_mask(scratch.returns_of_block[block] - 1));
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int block = kFirst; block <= kLast; ++block) join(scratch, block, -1);
    for (int block = kLast; block >= kFirst; --block) join(scratch, block, 1);
  }
}

// The blocks of parts with at least 1/300 of the largest part's returns, and at least four of them where the
// largest has 48 or more.
BlockMask find_large_parts(Scratch& scratch) {
  constexpr int kLargestOverSmallest = 300;
  constexpr int kEnough = 4, kLargestOverEnough = 12;
  auto& part = scratch.part_of_block;
  auto& returns = scratch.returns_of_part;
  returns.fill(0);
  int largest = 0;
  for (int block = 0; block < Scratch::kAllBlocks; ++block) {
    const int number =
        part[block] & sign_mask(part[block] - kNoPart);  // empty blocks: block 0, of the margin
    returns[number] = static_cast<std::uint16_t>(returns[number] + scratch.returns_of_block[block]);
    largest = max_small(largest, returns[number]);
    part[block] = static_cast<std::uint16_t>(number);
  }
  const int needed = max(largest / kLargestOverSmallest, min(kEnough, largest / kLargestOverEnough));
  BlockMask large{};
  for (int row = 0; row < Scratch::kBlocks; ++row) {
    for (int column = 0; column < Scratch::kBlocks; ++column) {
      const int of_part = returns[part[block_at(row, column)]];
      large[row] = 2 * large[row] + static_cast<BlockRow>(~sign_mask(of_part - needed) & 1);
    }
  }
  return large;
}

void drop_small_parts(const BlockMask& large, RayMask& mask) {
  for (int row = 0; row < RangeImage::kMaxRays; ++row)
    for (int word = 0; word < kWords; ++word)
      mask.rows[row][word] &= rays_of(large[row / Scratch::kBlockRays], word);
}

}  // namespace

void select_target(const RangeImage& frame, std::uint32_t target_radius_mm, TargetSelectionScratch& scratch,
                   RayMask& mask) {
  count_bins(frame, largest_step_counts(target_radius_mm), scratch);
  count_slices(target_radius_mm, scratch);
  const int median = median_of_slices(scratch);
  const Slice slice = nearest_filled_slice(scratch, median, target_radius_mm);
  choose_slice(frame, scratch, with_tails(scratch, slice, median), mask);

  for (int row = 0; row < frame.rays; ++row) count_support(mask, row, scratch);
  count_blocks(mask, scratch);
  drop_unsupported(scratch, frame.rays, neighbours_needed(mask, scratch, frame.rays), mask);

  count_blocks(mask, scratch);
  number_parts(scratch);
  drop_small_parts(find_large_parts(scratch), mask);
}

}  // namespace tumblesight::gnc
