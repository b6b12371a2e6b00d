// Verifies TS-NUM-010, TS-MEM-090.
#include "gnc/nn/kernels/kernels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "gnc/nn/lstm.hpp"
#include "tests/unit/gnc/nn/random_values.hpp"

namespace tumblesight::gnc {
namespace {

// The definition in product.hpp, one number at a time.
template <class Kind>
std::vector<typename Kind::Sum> by_definition(const ProductShape& s,
                                              const std::vector<typename Kind::Input>& in,
                                              const std::vector<typename Kind::Sum>& start,
                                              const std::vector<typename Kind::Weight>& weights) {
  std::vector<typename Kind::Sum> out;
  for (int y = 0; y < s.rows; ++y) {
    for (int x = 0; x < s.columns; ++x) {
      for (int c = 0; c < s.channels; ++c) {
        typename Kind::Sum sum = start[c];
        for (int t = 0; t < s.strips; ++t) {
          for (int i = 0; i < s.strip_length; ++i) {
            const int index = t * s.strip_length + i;
            const int weight = (index / Kind::kGroup * s.channels + c) * Kind::kGroup + index % Kind::kGroup;
            sum += in[y * s.row_step + x * s.column_step + t * s.strip_step + i] * weights[weight];
          }
        }
        out.push_back(sum);
      }
    }
  }
  return out;
}

ProductShape convolution(int rows, int columns, int in, int out) {
  const int row = (columns + 2) * in;
  return {rows, columns, row, in, 3, 3 * in, row, out};
}
ProductShape dense(int in, int out) {
  return {1, 1, 0, 0, 1, in, 0, out};
}

// Numbers of channels and pixels that cover every block size and every remainder.
std::vector<ProductShape> shapes(bool integers) {
  std::vector<ProductShape> all;
  std::vector<int> channels{16, 32, 48, 64, 96, 128, 144, 160, 240};
  if (!integers) channels.insert(channels.end(), {1, 3, 4, 15, 57, 100});
  for (const int out : channels) {
    all.push_back(convolution(5, 5, 4, out));
    all.push_back(convolution(1, 3, 4, out));  // fewer pixels than any block
    all.push_back(dense(38, out));
  }
  all.push_back(convolution(2, 3, 4, 64));
  all.push_back(convolution(3, 3, 8, 48));
  all.push_back(convolution(2, 24, 32, 64));
  all.push_back(convolution(2, 4, 4, 16));
  all.push_back(convolution(1, 4, 8, 32));  // fewer pixels than three tiles of two
  all.push_back(convolution(2, 4, 4, 16));
  all.back().strips = 17;  // more than a chunk holds
  all.push_back(dense(382, 768));
  return all;
}

// Rows of blocks beside the padding: on both sides of a row, and on the left only.
std::vector<ProductShape> shapes_with_zeros() {
  std::vector<ProductShape> all;
  for (const int columns : {6, 12, 24}) {
    for (const int channels : {16, 48, 64}) {
      for (const bool on_both_sides : {true, false}) {
        all.push_back(convolution(2, columns, 8, channels));
        all.back().zeros_left = 8;
        all.back().zeros_right = on_both_sides ? 8 : 0;
      }
    }
  }
  return all;
}

// The zeros that `s` states.
template <class Kind>
void clear_zeros(const ProductShape& s, std::vector<typename Kind::Input>& in) {
  for (int y = 0; y < s.rows; ++y) {
    for (int t = 0; t < s.strips; ++t) {
      const auto first = in.begin() + y * s.row_step + t * s.strip_step;
      const auto last = first + (s.columns - 1) * s.column_step + s.strip_length;
      std::fill(first, first + s.zeros_left, typename Kind::Input{});
      std::fill(last - s.zeros_right, last, typename Kind::Input{});
    }
  }
}

std::size_t input_size(const ProductShape& s) {
  return static_cast<std::size_t>((s.rows - 1) * s.row_step + (s.columns - 1) * s.column_step +
                                  (s.strips - 1) * s.strip_step + s.strip_length);
}

template <class Kind>
void expect_definition(Product<Kind>* product, const ProductShape& s,
                       const std::vector<typename Kind::Input>& in,
                       const std::vector<typename Kind::Sum>& start,
                       const std::vector<typename Kind::Weight>& weights) {
  using Sum = typename Kind::Sum;
  const std::vector<Sum> expected = by_definition<Kind>(s, in, start, weights);
  // One extra number at each end shows writes outside the output.
  std::vector<Sum> out(expected.size() + 2, Sum{123});
  product(s, in.data(), start.data(), weights.data(), out.data() + 1);
  ASSERT_EQ(std::memcmp(out.data() + 1, expected.data(), expected.size() * sizeof(Sum)), 0);
  EXPECT_EQ(out.front(), Sum{123});
  EXPECT_EQ(out.back(), Sum{123});
}

template <class Kind>
void expect_definition_for_all_shapes(Product<Kind>* product) {
  constexpr bool kIntegers = Kind::kGroup > 1;
  RandomValues random(7);
  std::vector<ProductShape> all = shapes(kIntegers);
  // Enough inputs for a second chunk. Sums of 16-bit inputs would exceed 32 bits.
  if (std::is_same_v<Kind, Int8Product>) {
    all.push_back(convolution(1, 10, 72, 16));
    all.push_back(convolution(2, 12, 96, 16));  // more inputs than AVX2 widens beforehand
    for (const ProductShape& s : shapes_with_zeros()) all.push_back(s);
  }
  for (ProductShape s : all) {
    SCOPED_TRACE(::testing::Message()
                 << s.rows << "x" << s.columns << ", " << s.strip_length << " to " << s.channels);
    s.strip_length = s.strip_length / Kind::kGroup * Kind::kGroup;
    const std::size_t weights = static_cast<std::size_t>(s.strips) * s.strip_length * s.channels;
    auto start = random.vector<typename Kind::Sum>(s.channels);
    if (kIntegers) {
      for (auto& value : start) value = static_cast<typename Kind::Sum>(value / 4);
    }
    auto in = random.vector<typename Kind::Input>(input_size(s));
    clear_zeros<Kind>(s, in);
    expect_definition<Kind>(product, s, in, start, random.vector<typename Kind::Weight>(weights));
    if (!kIntegers) continue;
    std::fill(in.begin(), in.end(), std::numeric_limits<typename Kind::Input>::max());
    clear_zeros<Kind>(s, in);
    for (const int sign : {-1, 1}) {
      expect_definition<Kind>(
          product, s, in, std::vector<typename Kind::Sum>(s.channels, 0),
          std::vector<typename Kind::Weight>(weights, static_cast<typename Kind::Weight>(127 * sign)));
    }
  }
}

// Two rows of sums to be pooled, and the shift of each channel.
template <class N>
struct PoolingInput {
  static constexpr int kColumns = 10, kChannels = 48;
  std::vector<Sum<N>> sums;
  std::vector<std::uint8_t> shift = std::vector<std::uint8_t>(kChannels);

  PoolingInput() {
    RandomValues random(11);
    sums = random.vector<Sum<N>>(2 * kColumns * kChannels);
    if (N::kIsInteger) {
      for (auto& sum : sums) sum = static_cast<Sum<N>>(sum / 2);
    }
    for (int c = 0; c < kChannels; ++c) shift[c] = static_cast<std::uint8_t>(1 + (c * 7) % 28);
  }
  std::array<double, 4> window(int x, int c) const {
    const auto at = [&](int row, int column) -> double {
      return sums[(row * kColumns + 2 * x + column) * kChannels + c];
    };
    return {at(0, 0), at(0, 1), at(1, 0), at(1, 1)};
  }
  // Rounded to the nearest, halves up.
  double activated(double sum, int c, double largest_integer) const {
    if (!N::kIsInteger) return std::max(0.0, sum);
    return std::min(largest_integer, std::max(0.0, std::floor(std::ldexp(sum, -shift[c]) + 0.5)));
  }
};

template <class N>
void expect_max_pool_by_definition(MaxPool<N>* max_pool) {
  const PoolingInput<N> input;
  std::vector<ConvInput<N>> out(input.kColumns / 2 * input.kChannels);
  max_pool(input.sums.data(), input.kColumns, input.kChannels, input.shift.data(), out.data());
  for (int x = 0; x < input.kColumns / 2; ++x) {
    for (int c = 0; c < input.kChannels; ++c) {
      const auto window = input.window(x, c);
      const double expected = input.activated(*std::max_element(window.begin(), window.end()), c, 255.0);
      ASSERT_EQ(out[x * input.kChannels + c], expected) << x << ' ' << c;
    }
  }
}

// The mean in float32, summed in order; the sum in fixed point.
template <class N>
void expect_average_pool_by_definition(AveragePool<N>* average_pool) {
  const PoolingInput<N> input;
  std::vector<DenseInput<N>> out(input.kColumns / 2 * input.kChannels);
  average_pool(input.sums.data(), input.kColumns, input.kChannels, input.shift.data(), out.data());
  for (int x = 0; x < input.kColumns / 2; ++x) {
    for (int c = 0; c < input.kChannels; ++c) {
      Sum<N> total = 0;
      for (const double sum : input.window(x, c))
        total += static_cast<Sum<N>>(input.activated(sum, c, kMaxAveragedActivation));
      ASSERT_EQ(out[x * input.kChannels + c], N::kIsInteger ? total : total / 4) << x << ' ' << c;
    }
  }
}

// A padded image, convolved and pooled.
class PooledImage {
 public:
  explicit PooledImage(const ImageShape& shape)
      : shape_(shape),
        in_(static_cast<std::size_t>(shape.side + 2) * shape.row()),
        start_(shape.channels_out),
        weights_(static_cast<std::size_t>(9) * shape.channels_in * shape.channels_out),
        shift_(shape.channels_out) {
    for (int c = 0; c < shape.channels_out; ++c) shift_[c] = static_cast<std::uint8_t>(8 + c % 10);
  }

  // The largest transformed input of F(4x4, 3x3), 17340, in the first tile (winograd_filters.hpp); weights of
  // one sign.
  void fill_with_largest_transformed(int sign) {
    constexpr std::array<int, 6> kRow{0, -4, -4, 1, 1, 0};  // of B'
    const auto factor = [&](int at) { return at < 6 ? kRow[static_cast<std::size_t>(at)] : 0; };
    int value = 0;
    fill_image([&] {
      const int pixel = value++ / shape_.channels_in;
      const int y = pixel / shape_.side + 1, x = pixel % shape_.side + 1;  // the border comes first
      return static_cast<std::uint8_t>(factor(y) * factor(x) > 0 ? 255 : 0);
    });
    std::fill(weights_.begin(), weights_.end(), static_cast<std::int8_t>(127 * sign));
  }

  void fill_randomly(RandomValues& random) {
    fill_image([&random] { return random.next<std::uint8_t>(); });
    random.fill(weights_);
    for (std::int32_t& start : start_) start = random.next<std::int16_t>();
  }
  // The largest sums of one sign. `every_third`: of the other sign are the weights of every third pixel.
  void fill_with_largest(int sign, bool every_third) {
    fill_image([] { return std::uint8_t{255}; });
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      const std::size_t pixel = i / static_cast<std::size_t>(shape_.channels_in * shape_.channels_out);
      weights_[i] = static_cast<std::int8_t>(every_third && pixel % 3 == 1 ? -127 * sign : 127 * sign);
    }
  }

  template <class Out>
  void expect_definition(PooledConvolution<FixedPoint, Out>* convolution) const {
    const int side_out = shape_.side / 2;
    const int row = (side_out + 2) * shape_.channels_out;  // one pixel of each end must not be written
    std::vector<Out> out(static_cast<std::size_t>(side_out) * row, 77);
    std::vector<std::int32_t> scratch(kPooledConvolutionScratch + 1, 123);  // whatever it contains
    convolution(shape_, in_.data(), start_.data(), weights_.data(), shift_.data(),
                out.data() + shape_.channels_out, row, scratch.data());
    EXPECT_EQ(scratch.back(), 123);
    EXPECT_EQ(out, by_parts<Out>(row));
  }

 private:
  template <class Next>
  void fill_image(const Next& next) {
    for (int y = 1; y <= shape_.side; ++y) {
      const auto first = in_.begin() + y * shape_.row() + shape_.channels_in;
      std::generate(first, first + shape_.side * shape_.channels_in, next);
    }
  }
  // Product and pooling one after the other.
  template <class Out>
  std::vector<Out> by_parts(int row) const {
    const Kernels<FixedPoint>& portable = *kernels_on<FixedPoint>(InstructionSet::kPortable);
    ProductShape two_rows = convolution(2, shape_.columns(), shape_.channels_in, shape_.channels_out);
    two_rows.row_step = two_rows.strip_step = shape_.row();
    std::vector<Out> out(static_cast<std::size_t>(shape_.side / 2) * row, 77);
    for (int y = 0; y < shape_.side / 2; ++y) {
      const auto first = in_.begin() + 2 * y * shape_.row();
      const std::vector<std::int32_t> sums =
          by_definition<Int8Product>(two_rows, {first, first + 4 * shape_.row()}, start_, weights_);
      Out* const pooled = out.data() + y * row + shape_.channels_out;
      if constexpr (std::is_same_v<Out, std::uint8_t>) {
        portable.max_pool(sums.data(), shape_.columns(), shape_.channels_out, shift_.data(), pooled);
      } else {
        portable.average_pool(sums.data(), shape_.columns(), shape_.channels_out, shift_.data(), pooled);
      }
    }
    return out;
  }

  ImageShape shape_;
  std::vector<std::uint8_t> in_;
  std::vector<std::int32_t> start_;
  std::vector<std::int8_t> weights_;
  std::vector<std::uint8_t> shift_;
};

class KernelsOf : public ::testing::TestWithParam<InstructionSet> {
 protected:
  template <class N>
  void check() {
    const Kernels<N>* kernels = kernels_on<N>(GetParam());
    if (kernels == nullptr) GTEST_SKIP() << "not built, or this processor lacks it";
    EXPECT_EQ(kernels->set, GetParam());
    expect_definition_for_all_shapes<typename N::ConvProduct>(kernels->convolve);
    expect_definition_for_all_shapes<typename N::DenseProduct>(kernels->multiply);
    expect_max_pool_by_definition<N>(kernels->max_pool);
    expect_average_pool_by_definition<N>(kernels->average_pool);
  }
};

TEST_P(KernelsOf, FixedPointHaveTheBitsOfTheirDefinition) {
  check<FixedPoint>();
}
TEST_P(KernelsOf, Float32HaveTheBitsOfTheirDefinition) {
  check<Float32>();
}
template <class Out>
void expect_both_parts(PooledConvolution<FixedPoint, Out>* (*convolution_of)(const ImageShape&)) {
  if (convolution_of == nullptr) GTEST_SKIP() << "has none";
  RandomValues random(12);
  // Those of the network; odd sides and other numbers of channels; several batches of tiles.
  const ImageShape shapes[] = {{50, 4, 16},  {25, 16, 48},  {12, 48, 96}, {6, 96, 160}, {50, 4, 32},
                               {25, 32, 64}, {12, 64, 128}, {7, 4, 48},   {13, 96, 32}, {16, 32, 96},
                               {20, 32, 32}, {2, 4, 16},    {3, 8, 16},   {4, 28, 16},  {5, 12, 32},
                               {10, 96, 16}, {22, 96, 16}};
  int convolutions = 0;
  for (const ImageShape& shape : shapes) {
    SCOPED_TRACE(::testing::Message()
                 << shape.side << ", " << shape.channels_in << " to " << shape.channels_out);
    PooledConvolution<FixedPoint, Out>* const convolution = convolution_of(shape);
    if (convolution == nullptr) continue;
    ++convolutions;
    PooledImage image(shape);
    image.fill_randomly(random);
    image.expect_definition(convolution);
    for (const int sign : {-1, 1}) {
      for (const bool every_third : {false, true}) {
        image.fill_with_largest(sign, every_third);
        image.expect_definition(convolution);
      }
      image.fill_with_largest_transformed(sign);
      image.expect_definition(convolution);
    }
  }
  EXPECT_GT(convolutions, 3);
}

// Without vectors every convolution of the network is one operation.
TEST_P(KernelsOf, WithoutVectorsDoWholeConvolutions) {
  const Kernels<FixedPoint>* kernels = kernels_on<FixedPoint>(GetParam());
  const bool has_vectors = GetParam() != InstructionSet::kPortable && GetParam() != InstructionSet::kDsp;
  if (kernels == nullptr || has_vectors) GTEST_SKIP() << "not built, or with vectors";
  for (const ImageShape& shape : {ImageShape{50, 4, 16}, ImageShape{25, 16, 48}, ImageShape{12, 48, 96}})
    EXPECT_NE(kernels->max_pooled_convolution(shape), nullptr) << shape.side;
  EXPECT_NE(kernels->average_pooled_convolution({6, 96, 160}), nullptr);
}

TEST_P(KernelsOf, ConvolveAndMaxPoolWithTheBitsOfBothParts) {
  const Kernels<FixedPoint>* kernels = kernels_on<FixedPoint>(GetParam());
  if (kernels == nullptr) GTEST_SKIP() << "not built, or this processor lacks it";
  expect_both_parts(kernels->max_pooled_convolution);
}
TEST_P(KernelsOf, ConvolveAndAveragePoolWithTheBitsOfBothParts) {
  const Kernels<FixedPoint>* kernels = kernels_on<FixedPoint>(GetParam());
  if (kernels == nullptr) GTEST_SKIP() << "not built, or this processor lacks it";
  expect_both_parts(kernels->average_pooled_convolution);
}

TEST_P(KernelsOf, UpdateTheLstmWithTheBitsOfItsDefinition) {
  const Kernels<FixedPoint>* kernels = kernels_on<FixedPoint>(GetParam());
  if (kernels == nullptr || kernels->update_lstm == nullptr) GTEST_SKIP() << "has none";
  RandomValues random(13);
  constexpr int kHidden = 6400;
  std::vector<std::int32_t> gates(4 * kHidden);
  std::vector<std::uint8_t> shift(4 * kHidden);
  for (std::size_t i = 0; i < gates.size(); ++i) {
    gates[i] = random.next<std::int32_t>() >> (i % 31);
    shift[i] = static_cast<std::uint8_t>(1 + i % 62);
  }
  std::vector<Fixed> c(kHidden);
  for (int i = 0; i < kHidden; ++i) c[i] = Fixed::from_raw(random.next<std::int32_t>() >> (i % 29));
  std::vector<std::int16_t> h(kHidden), expected_h(kHidden);
  std::vector<Fixed> expected_c = c;
  lstm_update(gates.data(), shift.data(), kHidden, expected_h.data(), expected_c.data());
  kernels->update_lstm(gates.data(), shift.data(), kHidden, h.data(), c.data());
  EXPECT_EQ(h, expected_h);
  EXPECT_EQ(c, expected_c);
}

TEST_P(KernelsOf, AddToTheOutputIfItIsTheStart) {
  const Kernels<FixedPoint>* kernels = kernels_on<FixedPoint>(GetParam());
  if (kernels == nullptr) GTEST_SKIP() << "not built, or this processor lacks it";
  RandomValues random(8);
  const ProductShape s = dense(18, 208);
  const auto in = random.vector<std::int16_t>(18);
  const auto weights = random.vector<std::int8_t>(18 * 208);
  std::vector<std::int32_t> out(208, 1000);
  const auto expected = by_definition<Int16Product>(s, in, out, weights);
  kernels->multiply(s, in.data(), out.data(), weights.data(), out.data());
  EXPECT_EQ(out, expected);
}

std::string name_of(const ::testing::TestParamInfo<InstructionSet>& set) {
  std::string name = to_string(set.param);
  for (char& letter : name) letter = letter == '-' ? '_' : letter;
  return name;
}
INSTANTIATE_TEST_SUITE_P(EverySet, KernelsOf, ::testing::ValuesIn(kInstructionSets), name_of);

TEST(FastestKernels, ExistForBothNumerics) {
  EXPECT_EQ(&fastest_kernels<FixedPoint>(), kernels_on<FixedPoint>(fastest_kernels<FixedPoint>().set));
  EXPECT_EQ(&fastest_kernels<Float32>(), kernels_on<Float32>(fastest_kernels<Float32>().set));
  EXPECT_NE(kernels_on<FixedPoint>(InstructionSet::kPortable), nullptr);
}

}  // namespace
}  // namespace tumblesight::gnc
