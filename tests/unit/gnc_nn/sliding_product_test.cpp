#include "gnc/nn/sliding_product.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "tests/unit/gnc_nn/random_values.hpp"

namespace tumblesight::gnc {
namespace {

// The definition in the header, one number after the other.
std::vector<float> by_definition(const SlidingProductShape& s, const std::vector<float>& in,
                                 const std::vector<float>& start, const std::vector<float>& weights) {
  std::vector<float> out;
  for (int y = 0; y < s.rows; ++y) {
    for (int x = 0; x < s.columns; ++x) {
      for (int c = 0; c < s.channels; ++c) {
        float sum = start[c];
        for (int t = 0; t < s.strips; ++t) {
          for (int i = 0; i < s.strip_length; ++i) {
            sum += in[y * s.row_step + x * s.column_step + t * s.strip_step + i] *
                   weights[(t * s.strip_length + i) * s.channels + c];
          }
        }
        out.push_back(sum);
      }
    }
  }
  return out;
}

SlidingProductShape convolution(int rows, int columns, int in, int out) {
  const int row = (columns + 2) * in;
  return {rows, columns, row, in, 3, 3 * in, row, out};
}

SlidingProductShape dense(int in, int out) {
  return {1, 1, 0, 0, 1, in, 0, out};
}

// Channel counts that meet every kernel and every remainder: below a pack, whole packs, packs and a rest.
std::vector<SlidingProductShape> shapes() {
  std::vector<SlidingProductShape> all;
  for (const int out : {1, 3, 4, 15, 16, 32, 48, 57, 64, 100, 128, 144, 240}) {
    all.push_back(convolution(5, 5, 3, out));
    all.push_back(convolution(1, 3, 2, out));  // fewer pixels than any block
    all.push_back(dense(37, out));
  }
  all.push_back(convolution(2, 3, 1, 64));  // exactly one block of six pixels
  all.push_back(convolution(3, 3, 2, 48));  // exactly one block of nine
  all.push_back(dense(184, 768));
  return all;
}

std::size_t input_size(const SlidingProductShape& s) {
  return (s.rows - 1) * s.row_step + (s.columns - 1) * s.column_step + (s.strips - 1) * s.strip_step +
         s.strip_length;
}

class SlidingProduct : public ::testing::TestWithParam<VectorUnit> {};

TEST_P(SlidingProduct, HasTheBitsOfItsDefinition) {
  if (!is_available(GetParam())) GTEST_SKIP() << "this processor lacks the vector unit";
  RandomValues random(7);
  for (const SlidingProductShape& s : shapes()) {
    SCOPED_TRACE(::testing::Message() << s.rows << "x" << s.columns << " to " << s.channels);
    const auto in = random.vector(input_size(s));
    const auto start = random.vector(s.channels);
    const auto weights = random.vector(static_cast<std::size_t>(s.strips) * s.strip_length * s.channels);
    const auto expected = by_definition(s, in, start, weights);
    // One number more at either end, so that unaligned and out-of-range writes show.
    std::vector<float> out(expected.size() + 2, 123.0F);
    sliding_product_on(GetParam(), s, in.data(), start.data(), weights.data(), out.data() + 1);
    ASSERT_EQ(std::memcmp(out.data() + 1, expected.data(), expected.size() * sizeof(float)), 0);
    EXPECT_EQ(out.front(), 123.0F);
    EXPECT_EQ(out.back(), 123.0F);
  }
}

TEST_P(SlidingProduct, AddsToWhatLiesInTheOutputWhenStartIsTheOutput) {
  if (!is_available(GetParam())) GTEST_SKIP() << "this processor lacks the vector unit";
  RandomValues random(8);
  const SlidingProductShape s = dense(19, 203);
  const auto in = random.vector(19);
  const auto weights = random.vector(19 * 203);
  std::vector<float> out = random.vector(203);
  const auto expected = by_definition(s, in, out, weights);
  sliding_product_on(GetParam(), s, in.data(), out.data(), weights.data(), out.data());
  EXPECT_EQ(out, expected);
}

std::string name_of(const ::testing::TestParamInfo<VectorUnit>& unit) {
  const char* names[] = {"Scalar", "Vector128Bit", "Avx2", "Avx512"};
  return names[static_cast<int>(unit.param)];
}

INSTANTIATE_TEST_SUITE_P(EveryUnit, SlidingProduct,
                         ::testing::Values(VectorUnit::kScalar, VectorUnit::k128Bit, VectorUnit::kAvx2,
                                           VectorUnit::kAvx512),
                         name_of);

}  // namespace
}  // namespace tumblesight::gnc
