#include "gnc/rcnn/model_image.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "gnc/rcnn/attitude_estimator.hpp"
#include "gnc/rcnn/crc32.hpp"
#include "tests/unit/gnc_rcnn/test_models.hpp"

namespace tumblesight::gnc {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

void put_u32(Bytes& image, std::size_t at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) image[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

std::uint32_t get_u32(const Bytes& image, std::size_t at) {
  return image[at] | image[at + 1] << 8 | image[at + 2] << 16 |
         static_cast<std::uint32_t>(image[at + 3]) << 24;
}

void put_f32(Bytes& image, std::size_t at, float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  put_u32(image, at, bits);
}

// Makes the header's CRC right again after a change, so that the check behind it is the one that speaks.
void seal_header(Bytes& image) {
  Crc32 crc;
  crc.add(image.data(), 88);
  crc.add(image.data() + 92, 16 * get_u32(image, 84));
  put_u32(image, 88, crc.value());
}

void seal_section(Bytes& image, int index) {
  const std::size_t entry = 92 + 16 * index;
  put_u32(image, entry + 12, crc32(image.data() + get_u32(image, entry + 4), get_u32(image, entry + 8)));
  seal_header(image);
}

const Bytes& good_image() {
  static const Bytes image = random_model_image(21);
  return image;
}

struct Damage {
  const char* name;
  ModelStatus expected;
  std::function<void(Bytes&)> apply;
};

std::vector<Damage> damages() {
  const auto sealed = [](auto change) {
    return [change](Bytes& b) {
      change(b);
      seal_header(b);
    };
  };
  return {
      {"Empty", ModelStatus::kTooShort, [](Bytes& b) { b.clear(); }},
      {"HalfAHeader", ModelStatus::kTooShort, [](Bytes& b) { b.resize(40); }},
      {"HalfASectionTable", ModelStatus::kTooShort, [](Bytes& b) { b.resize(100); }},
      {"OtherMagic", ModelStatus::kBadMagic, [](Bytes& b) { b[3] = 'X'; }},
      {"NextVersion", ModelStatus::kBadVersion, sealed([](Bytes& b) { b[4] = 3; })},
      {"OtherHeaderSize", ModelStatus::kBadSize, sealed([](Bytes& b) { b[6] = 96; })},
      {"NoSections", ModelStatus::kBadSize, sealed([](Bytes& b) { put_u32(b, 84, 0); })},
      {"AbsurdSectionCount", ModelStatus::kBadSize, [](Bytes& b) { put_u32(b, 84, 0xFFFFFFFFU); }},
      {"LastByteMissing", ModelStatus::kBadSize, [](Bytes& b) { b.pop_back(); }},
      {"OneByteMore", ModelStatus::kBadSize, [](Bytes& b) { b.push_back(0); }},
      {"OtherTotalSize", ModelStatus::kBadSize, sealed([](Bytes& b) { b[8] ^= 4; })},
      {"BitFlipInTarget", ModelStatus::kBadHeaderCrc, [](Bytes& b) { b[17] ^= 1; }},
      {"BitFlipInSectionTable", ModelStatus::kBadHeaderCrc, [](Bytes& b) { b[200] ^= 0x80; }},
      {"BitFlipInHeaderCrc", ModelStatus::kBadHeaderCrc, [](Bytes& b) { b[88] ^= 1; }},
      {"OtherArchitecture", ModelStatus::kBadArchitecture, sealed([](Bytes& b) { b[12] ^= 1; })},
      {"OtherTarget", ModelStatus::kBadTarget, sealed([](Bytes& b) { b[16] = 'b'; })},
      {"LongerTarget", ModelStatus::kBadTarget, sealed([](Bytes& b) { b[26] = 's'; })},
      {"UnnamedTarget", ModelStatus::kBadTarget,
       sealed([](Bytes& b) { std::fill_n(b.begin() + 16, 32, 0); })},
      {"UnterminatedTarget", ModelStatus::kBadTarget,
       sealed([](Bytes& b) { std::fill_n(b.begin() + 16, 32, 'a'); })},
      {"UnprintableTarget", ModelStatus::kBadTarget, sealed([](Bytes& b) { b[18] = 7; })},
      {"RubbishBehindTarget", ModelStatus::kBadTarget, sealed([](Bytes& b) { b[40] = 'x'; })},
      {"ZeroSwath", ModelStatus::kBadValue, sealed([](Bytes& b) { put_f32(b, 48, 0.0F); })},
      {"NanSwath", ModelStatus::kBadValue, sealed([](Bytes& b) { put_f32(b, 48, kNan); })},
      {"NegativeRadius", ModelStatus::kBadValue, sealed([](Bytes& b) { put_f32(b, 52, -3.0F); })},
      {"InfiniteRadius", ModelStatus::kBadValue, sealed([](Bytes& b) { put_f32(b, 52, kInfinity); })},
      {"UnknownEncoding", ModelStatus::kBadValue, sealed([](Bytes& b) { put_u32(b, 56, 2); })},
      {"NanInertia", ModelStatus::kBadValue, sealed([](Bytes& b) { put_f32(b, 64, kNan); })},
      {"InfiniteProductOfInertia", ModelStatus::kBadValue,
       sealed([](Bytes& b) { put_f32(b, 80, kInfinity); })},
      {"IndefiniteInertia", ModelStatus::kBadValue, sealed([](Bytes& b) { put_f32(b, 72, 50.0F); })},
      {"SectionMissing", ModelStatus::kBadSection, sealed([](Bytes& b) { put_u32(b, 84, 20); })},
      {"OtherSectionId", ModelStatus::kBadSection, sealed([](Bytes& b) { put_u32(b, 92, 2); })},
      {"SectionOffsetOutside", ModelStatus::kBadSection,
       sealed([](Bytes& b) { put_u32(b, 96, 0xFFFFFFF0U); })},
      {"OtherSectionSize", ModelStatus::kBadSection,
       sealed([](Bytes& b) { put_u32(b, 92 + 16 * 20 + 8, 1U << 31); })},
      {"BitFlipInFirstWeight", ModelStatus::kBadSectionCrc, [](Bytes& b) { b[428] ^= 1; }},
      {"BitFlipInLastWeight", ModelStatus::kBadSectionCrc, [](Bytes& b) { b.back() ^= 0x80; }},
      {"NanInFirstSection", ModelStatus::kBadValue,
       [](Bytes& b) {
         put_f32(b, 428, kNan);
         seal_section(b, 0);
       }},
      {"InfinityInLastSection", ModelStatus::kBadValue,
       [](Bytes& b) {
         put_f32(b, b.size() - 4, -kInfinity);
         seal_section(b, 20);
       }},
  };
}

class DamagedModelImage : public ::testing::TestWithParam<Damage> {};

TEST_P(DamagedModelImage, IsRefusedAndThePreviousModelStaysInUse) {
  static const auto estimator = std::make_unique<AttitudeEstimator>();
  static const auto untouched = std::make_unique<AttitudeEstimator>();
  ASSERT_EQ(estimator->load(good_image().data(), good_image().size(), "test_craft"), ModelStatus::kOk);
  ASSERT_EQ(untouched->load(good_image().data(), good_image().size(), "test_craft"), ModelStatus::kOk);
  AttitudeEstimate before, after;
  estimator->step(random_depth_image(1), before);
  untouched->step(random_depth_image(1), before);

  Bytes image = random_model_image(22);  // other weights than those in use
  GetParam().apply(image);
  EXPECT_EQ(estimator->load(image.data(), image.size(), "test_craft"), GetParam().expected)
      << to_string(GetParam().expected);

  EXPECT_TRUE(estimator->has_model());
  EXPECT_EQ(estimator->model().crc32, untouched->model().crc32);
  estimator->step(random_depth_image(2), after);
  untouched->step(random_depth_image(2), before);
  EXPECT_EQ(after.q_lrf_trf.coeffs(), before.q_lrf_trf.coeffs());
  EXPECT_EQ(after.predicted_error_rad, before.predicted_error_rad);
  EXPECT_EQ(estimator->state_crc32(), untouched->state_crc32());
}

INSTANTIATE_TEST_SUITE_P(EveryKind, DamagedModelImage, ::testing::ValuesIn(damages()),
                         [](const auto& damage) { return damage.param.name; });

TEST(ModelImage, ReadsBackWhatWasWrittenBitForBit) {
  auto written = std::make_unique<NetworkWeights>();
  auto read = std::make_unique<NetworkWeights>();
  fill_random(*written, 23);
  ModelHeader header = test_header();
  header.projection.encoding = DepthEncoding::kPaperMaximum;
  Bytes image(kModelImageSize);
  ASSERT_EQ(write_model_image(header, *written, image.data(), image.size()), kModelImageSize);
  ModelHeader found;
  ASSERT_EQ(read_model_image(image.data(), image.size(), "test_craft", found, *read), ModelStatus::kOk);
  EXPECT_EQ(std::memcmp(read.get(), written.get(), sizeof(NetworkWeights)), 0);
  EXPECT_EQ(found.target, header.target);
  EXPECT_EQ(found.projection.swath_m, header.projection.swath_m);
  EXPECT_EQ(found.projection.target_radius_m, header.projection.target_radius_m);
  EXPECT_EQ(found.projection.encoding, header.projection.encoding);
  EXPECT_EQ(found.inertia.tensor_trf, header.inertia.tensor_trf);
  EXPECT_EQ(found.inertia.inverse_trf, header.inertia.inverse_trf);
  EXPECT_NE(found.inertia.tensor_trf, Eigen::Matrix3f(Eigen::Matrix3f::Identity()));
  EXPECT_NE(found.crc32, 0U);
}

TEST(ModelImage, StandsInMemoryAsDocumented) {
  const Bytes& image = good_image();
  EXPECT_EQ(std::string(image.begin(), image.begin() + 4), "TSRM");
  EXPECT_EQ(image[4] + 256 * image[5], 2);
  EXPECT_EQ(image[6] + 256 * image[7], 92);
  EXPECT_EQ(get_u32(image, 8), image.size());
  EXPECT_EQ(get_u32(image, 12), architecture_hash());
  EXPECT_STREQ(reinterpret_cast<const char*>(image.data() + 16), "test_craft");
  EXPECT_EQ(get_u32(image, 48), 0x40F00000U);                     // 7.5
  const float inertia[] = {3.0F, 5.0F, 6.0F, 0.4F, -0.2F, 0.1F};  // xx, yy, zz, xy, xz, yz
  EXPECT_EQ(std::memcmp(image.data() + 60, inertia, sizeof inertia), 0);
  EXPECT_EQ(get_u32(image, 84), 21U);
  EXPECT_EQ(get_u32(image, 92), 1U);
  EXPECT_EQ(get_u32(image, 96), 428U);
  EXPECT_EQ(get_u32(image, 100), 9U * 4 * 32 * 4);
}

TEST(ModelImage, IsAcceptedForAnyTargetWhenNoneIsExpected) {
  ModelHeader header;
  auto weights = std::make_unique<NetworkWeights>();
  EXPECT_EQ(read_model_image(good_image().data(), good_image().size(), nullptr, header, *weights),
            ModelStatus::kOk);
  EXPECT_STREQ(header.target.data(), "test_craft");
  EXPECT_EQ(read_model_image(good_image().data(), good_image().size(), "", header, *weights),
            ModelStatus::kBadTarget);
  EXPECT_EQ(read_model_image(nullptr, 0, nullptr, header, *weights), ModelStatus::kTooShort);
}

TEST(ModelImage, IsNotWrittenWhereItDoesNotFit) {
  auto weights = std::make_unique<NetworkWeights>();
  Bytes out(kModelImageSize - 1, 0x55);
  EXPECT_EQ(write_model_image(test_header(), *weights, out.data(), out.size()), 0U);
  EXPECT_EQ(out, Bytes(kModelImageSize - 1, 0x55));
}

TEST(ModelImage, EverySingleBitFlipInHeaderAndSectionTableIsFound) {
  Bytes image = good_image();
  ModelHeader header;
  auto weights = std::make_unique<NetworkWeights>();
  for (std::size_t bit = 0; bit < 8 * kModelDataOffset; ++bit) {
    image[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    ASSERT_NE(read_model_image(image.data(), image.size(), nullptr, header, *weights), ModelStatus::kOk)
        << bit;
    image[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
  }
}

TEST(ModelHeader, TakesOnlyNamesThatTheReaderAccepts) {
  ModelHeader header = test_header();
  EXPECT_FALSE(set_target(header, ""));
  EXPECT_FALSE(set_target(header, std::string(32, 'a').c_str()));
  EXPECT_FALSE(set_target(header, "tab\tbed"));
  EXPECT_STREQ(header.target.data(), "test_craft");
  EXPECT_TRUE(set_target(header, std::string(31, 'a').c_str()));
}

TEST(ModelStatus, EveryValueHasItsOwnWords) {
  std::vector<std::string> words;
  for (int i = 0; i <= static_cast<int>(ModelStatus::kBadValue); ++i) {
    words.emplace_back(to_string(static_cast<ModelStatus>(i)));
  }
  std::sort(words.begin(), words.end());
  EXPECT_EQ(std::adjacent_find(words.begin(), words.end()), words.end());
}

}  // namespace
}  // namespace tumblesight::gnc
