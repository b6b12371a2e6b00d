#include "gnc/lidar/target_selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "gnc/lidar/depth_image.hpp"
#include "tests/support/trials.hpp"

namespace tumblesight::gnc {
namespace {

constexpr std::uint32_t kRadius_mm = 3'000;

// Gives the same numbers on every platform for the same seed.
class Chances {
 public:
  explicit Chances(unsigned seed) : engine_(seed) {}
  int below(int limit) { return static_cast<int>(engine_() % static_cast<unsigned>(limit)); }
  bool happens(double probability) { return static_cast<double>(engine_()) < probability * 4294967296.0; }

 private:
  std::mt19937 engine_;
};

TEST(RayMask, FindsEveryRayAndEveryPair) {
  const auto mask = std::make_unique<RayMask>();
  for (int row = 0; row < RangeImage::kMaxRays; ++row) {
    for (int column = 0; column < RangeImage::kMaxRays; ++column) {
      *mask = {};
      mask->rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column / 32)] =
          0x8000'0000U >> (column % 32);
      EXPECT_TRUE(mask->has(row, column));
      EXPECT_FALSE(mask->has(row, column ^ 1));
      EXPECT_EQ(mask->pair(row, column & ~1), column % 2 == 0 ? 2U : 1U);
    }
  }
  for (std::uint32_t pair = 0; pair < 4; ++pair) EXPECT_EQ(rays_of_pair(pair), count_ones(pair));
}

class TargetSelection : public testing::Test {
 protected:
  void use_rays(int rays) {
    frame->rays = static_cast<std::uint16_t>(rays);
    frame->ranges.fill(0);
  }
  std::uint16_t& range(int row, int column) {
    return frame->ranges[static_cast<std::size_t>(row * frame->rays + column)];
  }
  void fill(const std::function<int(int row, int column)>& range_counts) {
    for (int row = 0; row < frame->rays; ++row)
      for (int column = 0; column < frame->rays; ++column)
        range(row, column) = static_cast<std::uint16_t>(range_counts(row, column));
  }
  void select() { select_target(*frame, kRadius_mm, *scratch, *mask); }
  bool is_chosen(int row, int column) const {
    return (mask->rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column / 32)] >>
            (31 - column % 32)) &
           1;
  }
  int chosen() const {
    int count = 0;
    for (int row = 0; row < RangeImage::kMaxRays; ++row)
      for (int column = 0; column < RangeImage::kMaxRays; ++column) count += is_chosen(row, column) ? 1 : 0;
    return count;
  }
  // A disc with two wings and a boom, 60 m away, with the noise of the paper's sensor: 0 beside it.
  int target(int row, int column) {
    const int x = column - 60, y = row - 66;
    const bool hit =
        x * x + y * y < 500 || (std::abs(y) < 9 && std::abs(x) < 52) || (x == 0 && y > -55 && y < 0);
    return hit ? 60 * 128 + random.below(300) - 150 : 0;
  }
  int returns() const {
    return static_cast<int>(std::count_if(frame->ranges.begin(), frame->ranges.end(),
                                          [](std::uint16_t counts) { return counts != 0; }));
  }

  Chances random{7};
  std::unique_ptr<RangeImage> frame = [] {
    auto image = std::make_unique<RangeImage>();
    image->rays = 128;
    return image;
  }();
  std::unique_ptr<TargetSelectionScratch> scratch = std::make_unique<TargetSelectionScratch>();
  std::unique_ptr<RayMask> mask = std::make_unique<RayMask>();
};

// Verifies TS-LID-100.
TEST_F(TargetSelection, KeepsEveryReturnOfATargetWithoutClutter) {
  fill([this](int row, int column) { return target(row, column); });
  select();
  EXPECT_EQ(chosen(), returns());
}

// Verifies TS-LID-100.
TEST_F(TargetSelection, KeepsMostReturnsOfATargetThatReflectsFewRays) {
  for (const double share : {0.5, 0.2, 0.1}) {
    SCOPED_TRACE(share);
    fill([&](int row, int column) { return random.happens(share) ? target(row, column) : 0; });
    select();
    EXPECT_GE(chosen(), returns() * 0.9);
  }
}

// Verifies TS-LID-100. The range gate ends at 500 m, within a bin of the ranges.
TEST_F(TargetSelection, ReturnsJustBeyondTheRangeGateDoNotHideTheTarget) {
  for (const int beyond : {64'001, 64'050, 64'127, 64'128, 65'535}) {
    fill([&](int row, int column) {
      return abs(row - 60) < 6 && abs(column - 60) < 6 ? 60 * 128 + random.below(300) : beyond;
    });
    select();
    EXPECT_EQ(chosen(), 11 * 11) << beyond;
  }
}

// Verifies TS-LID-100. The farthest range is still one.
TEST_F(TargetSelection, KeepsATargetAtTheEndOfTheRangeGate) {
  fill([](int, int column) { return 64'000 - column % 2; });
  select();
  EXPECT_EQ(chosen(), 128 * 128);
}

// Verifies TS-LID-100. The largest target, seen from its end, fills slices over 100 m of ranges.
TEST_F(TargetSelection, LargestTargetIsNotTakenForClutter) {
  for (const std::uint32_t radius_mm : {kMinProjection_mm, kMaxTargetRadius_mm}) {
    const int depth = static_cast<int>(2 * radius_mm * 128 / 1000);
    for (const int nearest : {30, 100, 300}) {
      fill([&](int row, int column) {
        const bool hit = abs(row - 60) < 20 && abs(column - 60) < 20;
        return hit ? nearest * 128 + (row - 40) * depth / 39 + random.below(13) : 0;
      });
      select_target(*frame, radius_mm, *scratch, *mask);
      EXPECT_EQ(chosen(), 39 * 39) << radius_mm << ' ' << nearest;
    }
  }
}

// Verifies TS-LID-100.
TEST_F(TargetSelection, DropsFalseReturnsThatAreSpreadOverTheRanges) {
  for (const double share : {0.001, 0.003, 0.01, 0.03}) {
    SCOPED_TRACE(share);
    int of_target = 0, kept = 0, clutter = 0;
    std::vector<bool> is_target(static_cast<std::size_t>(RangeImage::kMaxReturns));
    fill([&](int row, int column) {
      const int hit = target(row, column);
      const bool is_false = random.happens(share);
      is_target[static_cast<std::size_t>(row * 128 + column)] = hit != 0 && !is_false;
      return is_false ? 1280 + random.below(64000 - 1280) : hit;
    });
    select();
    for (int row = 0; row < 128; ++row) {
      for (int column = 0; column < 128; ++column) {
        const bool good = is_target[static_cast<std::size_t>(row * 128 + column)];
        of_target += good ? 1 : 0;
        kept += good && is_chosen(row, column) ? 1 : 0;
        clutter += !good && is_chosen(row, column) ? 1 : 0;
      }
    }
    EXPECT_GE(kept, of_target * 0.995);
    EXPECT_LE(clutter,
              2 + 16384 * share * 0.02);  // 6 m of 490 m: 1.2 % of them are as far away as the target
  }
}

// Verifies TS-LID-100.
TEST_F(TargetSelection, DropsHotPixelsAtOneRangeWithinTheTargetsDepth) {
  fill([this](int row, int column) { return random.happens(0.01) ? 61 * 128 : target(row, column); });
  select();
  int stray = 0;
  for (int row = 0; row < 30; ++row)  // above the target, except for its boom
    for (int column = 0; column < 128; ++column)
      stray += is_chosen(row, column) && std::abs(column - 60) > 3 ? 1 : 0;
  EXPECT_LE(stray, 2);
}

// Verifies TS-LID-100.
TEST_F(TargetSelection, DropsDarkCountsThatAreDenseInFrontOfTheTarget) {
  int of_target = 0;
  fill([&](int row, int column) {  // in front of the target, 3 % of the rays, most of them 10 to 20 m away
    const int hit = target(row, column);
    const bool is_dark = random.happens(0.03);
    of_target += hit != 0 && !is_dark ? 1 : 0;
    return is_dark ? 1280 + random.below(1 + random.below(5000)) : hit;
  });
  select();
  EXPECT_GE(chosen(), of_target * 0.99);
  EXPECT_LE(chosen(), of_target * 1.01);
}

// Verifies TS-LID-100.
TEST_F(TargetSelection, DropsWhateverFillsTheViewBehindTheTarget) {
  int of_target = 0;
  fill([&](int row, int column) {
    const int hit = target(row, column);
    of_target += hit != 0 ? 1 : 0;
    return hit != 0 ? hit : 90 * 128 + random.below(300);
  });
  select();
  EXPECT_EQ(chosen(), of_target);
}

// Verifies TS-LID-100. Normal noise of 5 m: the slice alone, 10 m deep, holds two thirds of the returns.
TEST_F(TargetSelection, GoesOnWhereTheRangesAreNoisierThanThePapers) {
  const auto noise = [this] {
    int sum = 0;
    for (int i = 0; i < 12; ++i) sum += random.below(1001);
    return (sum - 6000) * 5 * 128 / 1000;
  };
  fill([&](int row, int column) {
    const int hit = target(row, column);
    return hit != 0 ? hit + noise() : 0;
  });
  select();
  EXPECT_GE(chosen(), returns() * 0.98);
}

// Verifies TS-LID-100. A second body in the view, as large, does not belong to the target.
TEST_F(TargetSelection, DoesNotGoOnAcrossAGap) {
  int of_target = 0;
  fill([&](int row, int column) {
    const int hit = target(row, column);
    of_target += hit != 0 && column < 64 ? 1 : 0;
    return hit != 0 && column >= 64 ? hit + 14 * 128 : hit;
  });
  select();
  EXPECT_EQ(chosen(), of_target);
}

// Verifies TS-LID-100.
TEST_F(TargetSelection, DropsAPieceBesideTheTargetThatIsTinyAgainstIt) {
  fill([this](int row, int column) { return target(row, column); });
  const int of_target = returns();
  range(5, 5) = range(5, 6) = range(6, 5) = 60 * 128;
  select();
  EXPECT_EQ(chosen(), of_target);
  EXPECT_FALSE(is_chosen(5, 5));
}

// Verifies TS-LID-100.
TEST_F(TargetSelection, KeepsNothingOfAFrameThatHoldsOnlyClutter) {
  fill([this](int, int) { return random.happens(0.01) ? 1280 + random.below(64000 - 1280) : 0; });
  select();
  EXPECT_LT(chosen(), kMinReturns);
}

// Verifies TS-LID-030.
TEST_F(TargetSelection, FollowsATargetToNearerThanTheNearestRange) {
  fill([](int row, int column) {  // a plate from 7.5 to 12.5 m, and a mast 3 to 4 m away
    if (column < 10) return 3 * 128 + row;
    return row < 20 || row > 100 ? 0 : 960 + 5 * column + row % 3;
  });
  select();
  for (int row = 0; row < 128; ++row)
    for (int column = 0; column < 128; ++column)
      EXPECT_EQ(is_chosen(row, column), column >= 10 && row >= 20 && row <= 100) << row << ' ' << column;
}

// Verifies TS-LID-030.
TEST_F(TargetSelection, LeavesOutPartsOfTheChaserInFrontOfATarget) {
  for (const int target_m : {11, 12, 20}) {
    fill([target_m](int row, int column) {
      if (column > 60 && column < 70) return 2 * 128 + 7 * row;  // a boom from 2 to 9 m
      return row < 20 || row > 100 ? 0 : target_m * 128 + column;
    });
    select();
    for (int row = 0; row < 128; ++row)
      for (int column = 0; column < 128; ++column)
        EXPECT_EQ(is_chosen(row, column), row >= 20 && row <= 100 && !(column > 60 && column < 70));
  }
}

// The selection as docs/numerics.md defines it, with one bool per ray.
class Definition {
 public:
  Definition(const RangeImage& frame, int radius_mm)
      : frame_(frame), n_(frame.rays), radius_mm_(radius_mm), chosen_(static_cast<std::size_t>(n_ * n_)) {
    choose_slice();
    drop_unsupported();
    drop_small_parts();
  }
  bool is_chosen(int row, int column) const {
    return row >= 0 && column >= 0 && row < n_ && column < n_ &&
           chosen_[static_cast<std::size_t>(row * n_ + column)];
  }

 private:
  int slice_bins(int bin) const { return (2 * radius_mm_ + 4 * (100 + 10 * bin)) * 131 / 131072 + 2; }
  int range(int row, int column) const { return frame_.ranges[static_cast<std::size_t>(row * n_ + column)]; }
  template <class Function>
  void for_each_ray(Function function) const {
    for (int row = 0; row < n_; ++row)
      for (int column = 0; column < n_; ++column) function(row, column);
  }

  void choose_slice() {
    std::vector<int> of_bin(512), of_slice(512), pairs_of_bin(512), pairs_of_slice(512);
    for_each_ray([&](int row, int column) {
      const auto usable = [&](int at) { return range(row, at) > 64'000 ? 0 : range(row, at); };
      const auto bin = static_cast<std::size_t>(usable(column) / 128);
      const int next = column + 1 < n_ ? usable(column + 1) : 0;
      ++of_bin[bin];
      pairs_of_bin[bin] += std::abs(usable(column) - next) <= radius_mm_ * 131 / 1024 ? 1 : 0;
    });
    for (int bin = 0; bin < 512; ++bin)
      for (int i = std::max(bin, 10); i <= std::min(500, bin + slice_bins(bin) - 1); ++i) {
        of_slice[static_cast<std::size_t>(bin)] += of_bin[static_cast<std::size_t>(i)];
        pairs_of_slice[static_cast<std::size_t>(bin)] += pairs_of_bin[static_cast<std::size_t>(i)];
      }
    std::vector<int> sorted = of_slice;
    std::sort(sorted.begin(), sorted.end());
    const int needed = std::max({16, 4 * sorted[256], sorted.back() / 64});
    const auto first_filled = [&](int pairs_needed_of_16) {
      int bin = 0;
      const auto is_filled = [&](std::size_t i) {
        return of_slice[i] >= needed && 16 * pairs_of_slice[i] >= pairs_needed_of_16 * of_slice[i];
      };
      while (bin < 512 && !is_filled(static_cast<std::size_t>(bin))) ++bin;
      return bin;
    };
    const int nearest = first_filled(1) < 512 ? first_filled(1) : first_filled(0);
    if (nearest == 512) return;
    int best = nearest;
    for (int bin = nearest; bin < std::min(512, nearest + slice_bins(nearest)); ++bin)
      if (of_slice[static_cast<std::size_t>(bin)] > of_slice[static_cast<std::size_t>(best)]) best = bin;
    const auto is_filled = [&](int bin) { return of_bin[static_cast<std::size_t>(bin)] >= 4; };
    const auto at = [&](int bin) {  // a bin that is used
      return bin < 10 || bin > 500 ? 0 : of_bin[static_cast<std::size_t>(bin)];
    };
    const int depth = slice_bins(best);
    int first = best, last = std::min(511, best + depth - 1);
    const auto goes_on = [&](int next, int here, int before) {
      return at(next) >= 4 && 8 * at(next) >= 3 * before && at(next) * depth >= 4 * sorted[256] &&
             std::abs(next - here) <= std::min(32, depth);
    };
    const int near = first, far = last;
    for (int before = std::max(at(far), at(far - 1)); goes_on(last + 1, far, before); ++last)
      before = at(last + 1);
    for (int before = std::max(at(near), at(near + 1)); goes_on(first - 1, near, before); --first)
      before = at(first - 1);
    int begin = 10, deepest = last;
    while (deepest > 10 && !is_filled(deepest)) --deepest;
    while (first <= 10 && begin > 1 && is_filled(10) && is_filled(begin - 1) &&
           begin - 1 > deepest - (last + 1 - first))
      --begin;
    for_each_ray([&](int row, int column) {
      const int counts = range(row, column);
      chosen_[static_cast<std::size_t>(row * n_ + column)] = counts >= begin * 128 && counts <= 64000 &&
                                                             (begin < 10 || counts >= first * 128) &&
                                                             counts < (last + 1) * 128;
    });
  }

  int around(int row, int column) const {
    int count = 0;
    for (int i = -2; i <= 2; ++i)
      for (int j = -2; j <= 2; ++j) count += is_chosen(row + i, column + j) ? 1 : 0;
    return count;
  }
  int of_block(int row, int column) const {
    int count = 0;
    for (int i = 0; i < 16; ++i) count += is_chosen(4 * row + i / 4, 4 * column + i % 4) ? 1 : 0;
    return count;
  }
  bool is_near_surface(int row, int column) const {
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        if (of_block(row / 4 + i, column / 4 + j) >= 8) return true;
    return false;
  }
  void drop_unsupported() {
    std::vector<int> supports;
    int alone = 0, with_one = 0;
    for_each_ray([&](int row, int column) {
      if (!is_chosen(row, column)) return;
      const int support = around(row, column);
      supports.push_back(support);
      if (is_near_surface(row, column)) return;
      alone += support == 1 ? 1 : 0;
      with_one += support == 2 ? 1 : 0;
    });
    if (alone < 16) return;
    std::sort(supports.begin(), supports.end(), std::greater<>());
    const int median = supports[(supports.size() + 1) / 2 - 1];  // half of them are as large
    const double mean = static_cast<double>(with_one) / alone;
    const int needed = std::min(mean < 0.3 ? 2 : mean < 0.7 ? 3 : mean < 1.2 ? 4 : 5, median / 4);
    std::vector<bool> kept = chosen_;
    for_each_ray([&](int row, int column) {
      if (around(row, column) < needed + 1) kept[static_cast<std::size_t>(row * n_ + column)] = false;
    });
    chosen_ = kept;
  }

  void drop_small_parts() {
    constexpr int kBlocks = 32;
    std::vector<int> part(kBlocks * kBlocks, -1), returns;
    const auto flood = [&](auto& self, int row, int column) -> void {
      if (row < 0 || column < 0 || row >= kBlocks || column >= kBlocks) return;
      int& number = part[static_cast<std::size_t>(row * kBlocks + column)];
      const int here = of_block(row, column);
      if (number >= 0 || here == 0) return;
      number = static_cast<int>(returns.size()) - 1;
      returns.back() += here;
      for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j) self(self, row + i, column + j);
    };
    int largest = 0;
    for (int block = 0; block < kBlocks * kBlocks; ++block) {
      returns.push_back(0);
      flood(flood, block / kBlocks, block % kBlocks);
      largest = std::max(largest, returns.back());
    }
    const int needed = std::max(largest / 300, std::min(4, largest / 12));
    for_each_ray([&](int row, int column) {
      const int number = part[static_cast<std::size_t>(row / 4 * kBlocks + column / 4)];
      if (number >= 0 && returns[static_cast<std::size_t>(number)] < needed)
        chosen_[static_cast<std::size_t>(row * n_ + column)] = false;
    });
  }

  const RangeImage& frame_;
  int n_, radius_mm_;
  std::vector<bool> chosen_;
};

// Verifies TS-LID-100.
TEST_F(TargetSelection, IsWhatTheDefinitionSays) {
  int frames_with_target = 0;
  constexpr double kShares[] = {0.0, 0.002, 0.02, 0.1, 0.3};
  constexpr int kSpreads[] = {1, 1024, 4096, 20000};  // of the ranges [counts]
  for (int trial = 0; trial < trials(60); ++trial) {
    SCOPED_TRACE(trial);
    use_rays(trial % 3 == 0 ? 128 : 16 + random.below(113));
    const int nearer = random.below(2) * (47 + random.below(10)) * 128;  // some targets are around 10 m away
    const double clutter = kShares[random.below(5)], hot = kShares[random.below(3)],
                 thin = random.below(2) == 0 ? 1.0 : kShares[3 + random.below(2)];
    const int spread = kSpreads[random.below(4)];
    fill([&](int row, int column) {
      if (random.happens(clutter)) return random.below(65536);
      if (random.happens(hot)) return 7700;
      const int hit = target(row * 128 / frame->rays, column * 128 / frame->rays);
      const int further = (random.below(spread) + random.below(spread)) / 2;
      return random.happens(thin) && hit > nearer ? hit - nearer + further : 0;
    });
    select();
    const Definition expected(*frame, kRadius_mm);
    int differ = 0;
    for (int row = 0; row < 128; ++row)
      for (int column = 0; column < 128; ++column)
        differ += is_chosen(row, column) != expected.is_chosen(row, column) ? 1 : 0;
    EXPECT_EQ(differ, 0) << "of " << chosen() << " chosen, " << frame->rays << " rays";
    frames_with_target += chosen() >= kMinReturns ? 1 : 0;
  }
  EXPECT_GT(frames_with_target, trials(60) / 2);
}

}  // namespace
}  // namespace tumblesight::gnc
