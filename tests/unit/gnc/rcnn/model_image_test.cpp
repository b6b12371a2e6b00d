#include "gnc/rcnn/model_image.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gnc/estimation/attitude_estimator.hpp"
#include "gnc/numerics/conversion.hpp"
#include "gnc/numerics/crc.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::gnc {
namespace {

using Bytes = std::vector<std::uint8_t>;

void put_u32(Bytes& image, std::size_t at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) image[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

std::uint32_t get_u32(const Bytes& image, std::size_t at) {
  return image[at] | image[at + 1] << 8 | image[at + 2] << 16 |
         static_cast<std::uint32_t>(image[at + 3]) << 24;
}

constexpr std::size_t kSections = 88;
constexpr std::size_t kHeaderCrc = 92;
constexpr std::size_t kTable = 96;
constexpr std::size_t kFloatData = 448;  // 96 + 16 * 21, to the next multiple of 64
constexpr std::size_t kFixedData = 640;  // 96 + 16 * 32, to the next multiple of 64

// Corrects the header's CRC after a change, so that a later check finds the error.
void seal_header(Bytes& image) {
  const std::size_t end = (kTable + 16 * get_u32(image, kSections) + 63) / 64 * 64;
  Crc32 crc;
  crc.add(image.data(), kHeaderCrc);
  if (end <= image.size()) crc.add(image.data() + kTable, end - kTable);
  put_u32(image, kHeaderCrc, crc.value());
}

void seal_section(Bytes& image, int index) {
  const std::size_t entry = kTable + 16 * index;
  put_u32(image, entry + 12, crc32(image.data() + get_u32(image, entry + 4), get_u32(image, entry + 8)));
  seal_header(image);
}

const Bytes& good_image() {
  return lasting_model_image<Float32>(21);
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
      {"NextVersion", ModelStatus::kBadVersion, sealed([](Bytes& b) { b[4] = 4; })},
      {"OtherHeaderSize", ModelStatus::kBadSize, sealed([](Bytes& b) { b[6] = 92; })},
      {"NoSections", ModelStatus::kBadSize, sealed([](Bytes& b) { put_u32(b, kSections, 0); })},
      {"HugeSectionCount", ModelStatus::kBadSize, [](Bytes& b) { put_u32(b, kSections, 0xFFFFFFFFU); }},
      {"LastByteMissing", ModelStatus::kBadSize, [](Bytes& b) { b.pop_back(); }},
      {"OneByteMore", ModelStatus::kBadSize, [](Bytes& b) { b.push_back(0); }},
      {"OtherTotalSize", ModelStatus::kBadSize, sealed([](Bytes& b) { b[8] ^= 4; })},
      {"BitFlipInTarget", ModelStatus::kBadHeaderCrc, [](Bytes& b) { b[17] ^= 1; }},
      {"BitFlipInSectionTable", ModelStatus::kBadHeaderCrc, [](Bytes& b) { b[200] ^= 0x80; }},
      {"BitFlipInHeaderCrc", ModelStatus::kBadHeaderCrc, [](Bytes& b) { b[kHeaderCrc] ^= 1; }},
      {"NonzeroByteBehindTheSectionTable", ModelStatus::kBadHeaderCrc,
       [](Bytes& b) { b[kFloatData - 1] = 1; }},
      {"OtherNumerics", ModelStatus::kBadNumerics, sealed([](Bytes& b) { b[84] = 1; })},
      {"UnknownNumerics", ModelStatus::kBadNumerics, sealed([](Bytes& b) { b[84] = 2; })},
      {"OtherArchitecture", ModelStatus::kBadArchitecture, sealed([](Bytes& b) { b[12] ^= 1; })},
      {"OtherTarget", ModelStatus::kBadTarget, sealed([](Bytes& b) { b[16] = 'b'; })},
      {"LongerTarget", ModelStatus::kBadTarget, sealed([](Bytes& b) { b[26] = 's'; })},
      {"UnnamedTarget", ModelStatus::kBadTarget,
       sealed([](Bytes& b) { std::fill_n(b.begin() + 16, 32, 0); })},
      {"UnterminatedTarget", ModelStatus::kBadTarget,
       sealed([](Bytes& b) { std::fill_n(b.begin() + 16, 32, 'a'); })},
      {"UnprintableTarget", ModelStatus::kBadTarget, sealed([](Bytes& b) { b[18] = 7; })},
      {"DeleteCharacterInTarget", ModelStatus::kBadTarget, sealed([](Bytes& b) { b[18] = 0x7F; })},
      {"NonzeroByteBehindTarget", ModelStatus::kBadTarget, sealed([](Bytes& b) { b[40] = 'x'; })},
      {"NoSwath", ModelStatus::kBadValue, sealed([](Bytes& b) { put_u32(b, 48, 99); })},
      {"HugeSwath", ModelStatus::kBadValue, sealed([](Bytes& b) { put_u32(b, 48, 100'001); })},
      {"NoRadius", ModelStatus::kBadValue, sealed([](Bytes& b) { put_u32(b, 52, 0); })},
      {"HugeRadius", ModelStatus::kBadValue, sealed([](Bytes& b) { put_u32(b, 52, 0xFFFFFFFFU); })},
      {"InertiaNotScaled", ModelStatus::kBadValue, sealed([](Bytes& b) { put_u32(b, 60, 5U << 24); })},
      {"LargestProductOfInertia", ModelStatus::kBadValue,
       sealed([](Bytes& b) { put_u32(b, 72, 0x80000000U); })},
      {"IndefiniteInertia", ModelStatus::kBadValue, sealed([](Bytes& b) { put_u32(b, 72, 2U << 24); })},
      {"SectionMissing", ModelStatus::kBadSection, sealed([](Bytes& b) { put_u32(b, kSections, 20); })},
      {"RoomBehindTheLastSection", ModelStatus::kBadSection, sealed([](Bytes& b) {
         b.resize(b.size() + 4);
         put_u32(b, 8, static_cast<std::uint32_t>(b.size()));
       })},
      {"OtherSectionId", ModelStatus::kBadSection, sealed([](Bytes& b) { put_u32(b, kTable, 2); })},
      {"SectionOffsetOutside", ModelStatus::kBadSection,
       sealed([](Bytes& b) { put_u32(b, kTable + 4, 0xFFFFFFF0U); })},
      {"OtherSectionSize", ModelStatus::kBadSection,
       sealed([](Bytes& b) { put_u32(b, kTable + 16 * 20 + 8, 1U << 31); })},
      {"BitFlipInFirstWeight", ModelStatus::kBadSectionCrc, [](Bytes& b) { b[kFloatData] ^= 1; }},
      {"BitFlipInLastWeight", ModelStatus::kBadSectionCrc, [](Bytes& b) { b.back() ^= 0x80; }},
      {"NanInFirstSection", ModelStatus::kBadValue,
       [](Bytes& b) {
         put_u32(b, kFloatData, 0x7FC00000U);
         seal_section(b, 0);
       }},
      {"InfinityInLastSection", ModelStatus::kBadValue,
       [](Bytes& b) {
         put_u32(b, b.size() - 4, 0xFF800000U);
         seal_section(b, 20);
       }},
  };
}

class DamagedModelImage : public ::testing::TestWithParam<Damage> {};

// Verifies TS-IFC-020, TS-IFC-030, TS-IFC-040, TS-IFC-050.
TEST_P(DamagedModelImage, IsRefusedAndThePreviousModelStaysInUse) {
  static const auto estimator = std::make_unique<AttitudeEstimator<Float32>>();
  static const auto untouched = std::make_unique<AttitudeEstimator<Float32>>();
  ASSERT_EQ(estimator->load(good_image().data(), good_image().size(), "test_craft"), ModelStatus::kOk);
  ASSERT_EQ(untouched->load(good_image().data(), good_image().size(), "test_craft"), ModelStatus::kOk);
  AttitudeEstimate before, after;
  estimator->step(random_depth_image(1), before);
  untouched->step(random_depth_image(1), before);

  Bytes image = random_model_image<Float32>(22);  // other weights than those in use
  GetParam().apply(image);
  EXPECT_EQ(estimator->load(image.data(), image.size(), "test_craft"), GetParam().expected)
      << to_string(GetParam().expected);

  EXPECT_TRUE(estimator->has_model());
  EXPECT_EQ(estimator->model().crc32, untouched->model().crc32);
  estimator->step(random_depth_image(2), after);
  untouched->step(random_depth_image(2), before);
  EXPECT_EQ(after.q_lrf_trf, before.q_lrf_trf);
  EXPECT_EQ(after.predicted_error_urad, before.predicted_error_urad);
  EXPECT_EQ(estimator->state_crc32(), untouched->state_crc32());
}

INSTANTIATE_TEST_SUITE_P(EveryKind, DamagedModelImage, ::testing::ValuesIn(damages()),
                         [](const auto& damage) { return damage.param.name; });

// Verifies TS-IFC-010.
TEST(ModelImage, ReadsBackWhatWasWrittenBitForBit) {
  auto written = std::make_unique<NetworkWeights<Float32>>();
  auto read = std::make_unique<NetworkWeights<Float32>>();
  fill_random(*written, 23);
  ModelHeader header = test_header();
  header.noise = {50, 40};
  Bytes image(kModelImageSize<Float32>);
  ASSERT_EQ(write_model_image<Float32>(header, *written, image.data(), image.size()),
            kModelImageSize<Float32>);
  ModelHeader found;
  ASSERT_EQ(read_model_image<Float32>(image.data(), image.size(), "test_craft", found, *read),
            ModelStatus::kOk);
  EXPECT_EQ(std::memcmp(read.get(), written.get(), sizeof(NetworkWeights<Float32>)), 0);
  EXPECT_EQ(found.target, header.target);
  EXPECT_EQ(found.projection.swath_mm, header.projection.swath_mm);
  EXPECT_EQ(found.projection.target_radius_mm, header.projection.target_radius_mm);
  EXPECT_EQ(found.noise, header.noise);
  EXPECT_EQ(get_u32(image, 56), 50U + (40U << 16));
  // Scaled to a trace of 3 once more, which rounds.
  const auto scaled = [](const ModelHeader& h) { return converted<float>(h.inertia.tensor_trf); };
  EXPECT_LT((scaled(found) - scaled(header)).norm(), 1e-6F);
  EXPECT_GT((scaled(found) - Eigen::Matrix3f::Identity()).norm(), 0.1F);
  EXPECT_NE(found.crc32, 0U);
}

// Verifies TS-IFC-010.
TEST(ModelImage, HasTheDocumentedLayout) {
  const Bytes& image = good_image();
  EXPECT_EQ(std::string(image.begin(), image.begin() + 4), "TSRM");
  EXPECT_EQ(image[4] + 256 * image[5], 3);
  EXPECT_EQ(image[6] + 256 * image[7], 96);
  EXPECT_EQ(get_u32(image, 8), image.size());
  EXPECT_EQ(get_u32(image, 12), architecture_hash());
  EXPECT_STREQ(reinterpret_cast<const char*>(image.data() + 16), "test_craft");
  EXPECT_EQ(get_u32(image, 48), 7500U);
  EXPECT_EQ(get_u32(image, 52), 3250U);
  EXPECT_EQ(get_u32(image, 56), 0U) << "the paper's noise: 0.1 m + 1 %";
  const double inertia[] = {3.0, 5.0, 6.0, 0.4, -0.2, 0.1};  // xx, yy, zz, xy, xz, yz
  for (int i = 0; i < 6; ++i) {
    const auto raw = static_cast<std::int32_t>(get_u32(image, 60 + 4 * static_cast<std::size_t>(i)));
    EXPECT_NEAR(raw / 16777216.0, inertia[i] * 3.0 / 14.0, 2e-7) << i;
  }
  EXPECT_EQ(get_u32(image, 84), 0U);
  EXPECT_EQ(get_u32(image, kSections), 21U);
  EXPECT_EQ(get_u32(image, kTable), 1U);
  EXPECT_EQ(get_u32(image, kTable + 4), kFloatData);
  EXPECT_EQ(get_u32(image, kTable + 8), 9U * 4 * 16 * 4);

  const Bytes& fixed = lasting_model_image<FixedPoint>(21);
  EXPECT_EQ(fixed.size(), kModelImageSize<FixedPoint>);
  EXPECT_EQ(fixed[4] + 256 * fixed[5], 5);
  EXPECT_EQ(get_u32(fixed, 84), 1U);
  EXPECT_EQ(get_u32(fixed, kSections), 33U);
  EXPECT_EQ(get_u32(fixed, kTable + 4), kFixedData);
  EXPECT_EQ(get_u32(fixed, kTable + 8), 9U * 4 * 16);                   // one byte per weight
  EXPECT_EQ(get_u32(fixed, kTable + 16 + 4), kFixedData + 9 * 4 * 16);  // bias
  EXPECT_EQ(get_u32(fixed, kTable + 16 + 8), 4U * 16);
  EXPECT_EQ(get_u32(fixed, kTable + 32 + 8), 4U * 16);  // shifts
  const std::size_t surface = kTable + std::size_t{16} * 31;
  EXPECT_EQ(get_u32(fixed, surface), 32U);
  EXPECT_EQ(get_u32(fixed, surface + 8), 8U + 9 * 2048);
  const std::size_t mesh = surface + 16;
  EXPECT_EQ(get_u32(fixed, mesh), 33U);
  EXPECT_EQ(get_u32(fixed, mesh + 4), get_u32(fixed, surface + 4) + get_u32(fixed, surface + 8));
  EXPECT_EQ(get_u32(fixed, mesh + 8), 120'840U);
  EXPECT_EQ(get_u32(fixed, mesh + 4) + get_u32(fixed, mesh + 8), fixed.size());
  EXPECT_EQ(fixed.size(), 995'792U);
}

TEST(IsFloat32, NeedsAnIntactHeader) {
  const Bytes& fixed = lasting_model_image<FixedPoint>(21);
  EXPECT_TRUE(is_float32(good_image().data(), good_image().size()));
  EXPECT_FALSE(is_float32(fixed.data(), fixed.size()));
  EXPECT_FALSE(is_float32(good_image().data(), 40));
  EXPECT_FALSE(is_float32(nullptr, 0));
  Bytes damaged = good_image();
  damaged[17] ^= 1;
  EXPECT_FALSE(is_float32(damaged.data(), damaged.size()));
}

ModelStatus read_fixed(const Bytes& image) {
  ModelHeader header;
  static auto weights = std::make_unique<NetworkWeights<FixedPoint>>();
  return read_model_image<FixedPoint>(image.data(), image.size(), nullptr, header, *weights);
}

// Section `index` of the fixed-point image. Each layer has three sections, the LSTM four.
std::size_t offset_of(const Bytes& image, int index) {
  return get_u32(image, kTable + 16 * static_cast<std::size_t>(index) + 4);
}

constexpr int kSurface = 31, kMesh = 32;  // sections

// Verifies TS-IFC-010, TS-IFC-020, TS-IFC-030, TS-IFC-040.
TEST(FixedPointImage, HoldsTheSurfaceOfTheTarget) {
  const Bytes& without = lasting_model_image<FixedPoint>(30);
  EXPECT_FALSE(surface_of<FixedPoint>(without.data()).is_known());
  EXPECT_FALSE(surface_of<Float32>(good_image().data()).is_known()) << "has no such section";
  ModelHeader header;
  auto weights = std::make_unique<NetworkWeights<FixedPoint>>();
  ASSERT_EQ(read_model_image<FixedPoint>(without.data(), without.size(), nullptr, header, *weights),
            ModelStatus::kOk);
  Bytes section(SurfaceModel::kBytes), image(without.size());
  put_u32(section, 0, 2);
  put_u32(section, 4, 150);
  const std::uint8_t second[] = {0x01, 0x80, 0xFF, 0x7F, 0xFE, 0xFF, 0x81, 0x7F, 0x00};
  std::copy(std::begin(second), std::end(second), section.begin() + 8 + 9);
  ASSERT_EQ(write_model_image<FixedPoint>(header, *weights, image.data(), image.size(), {section.data()}),
            image.size());
  ASSERT_EQ(read_fixed(image), ModelStatus::kOk);
  EXPECT_TRUE(std::equal(image.begin() + kFixedData,
                         image.end() - SurfaceModel::kBytes - SurfaceMesh::kMaxBytes,
                         without.begin() + kFixedData))
      << "weights";
  const SurfaceModel surface = surface_of<FixedPoint>(image.data());
  EXPECT_EQ(surface.points(), 2U);
  EXPECT_EQ(surface.spacing_mm(), 150U);
  EXPECT_EQ(surface.point(1).position, (std::array<std::int16_t, 3>{-32767, 32767, -2}));
  EXPECT_EQ(surface.point(1).normal, (std::array<std::int8_t, 3>{-127, 127, 0}));
  EXPECT_EQ(surface.point(2047).normal, (std::array<std::int8_t, 3>{0, 0, 0}));

  Bytes damaged = image;
  damaged[offset_of(image, kSurface) + SurfaceModel::kBytes - 1] ^= 1;
  EXPECT_EQ(read_fixed(damaged), ModelStatus::kBadSectionCrc);
  damaged = image;
  put_u32(damaged, offset_of(damaged, kSurface), 2049);
  seal_section(damaged, kSurface);
  EXPECT_EQ(read_fixed(damaged), ModelStatus::kBadValue);
  damaged = image;
  for (const std::uint8_t former : {3, 4}) {
    damaged[4] = former;
    seal_header(damaged);
    EXPECT_EQ(read_fixed(damaged), ModelStatus::kBadVersion) << int{former};
  }
}

// A tetrahedron: its triangles and its edges.
Bytes tetrahedron() {
  Bytes section(SurfaceMesh::kMaxBytes);
  std::size_t at = 0;
  const auto put = [&](std::initializer_list<int> numbers) {
    for (const int number : numbers) {
      section[at++] = static_cast<std::uint8_t>(number & 255);
      section[at++] = static_cast<std::uint8_t>((number >> 8) & 255);
    }
  };
  put({4, 4, 6, 37});
  put({0, 0, 32767, 20000, 0, -10000, -10000, 20000, -10000, -10000, -20000, -10000});
  put({0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2});
  put({0, 1, 2, 3, 0, 2, 1, 3, 0, 3, 1, 2, 1, 2, 0, 3, 1, 3, 0, 2, 2, 3, 0, 1});
  return section;
}
constexpr std::size_t kTetrahedronEnd = 8 + 6 * 4 + 6 * 4 + 8 * 6;

const Bytes& image_of_tetrahedron() {
  static const Bytes image = [] {
    const Bytes& without = lasting_model_image<FixedPoint>(30);
    ModelHeader header;
    auto weights = std::make_unique<NetworkWeights<FixedPoint>>();
    EXPECT_EQ(read_model_image<FixedPoint>(without.data(), without.size(), nullptr, header, *weights),
              ModelStatus::kOk);
    const Bytes mesh = tetrahedron();
    Bytes with(without.size());
    EXPECT_EQ(
        write_model_image<FixedPoint>(header, *weights, with.data(), with.size(), {nullptr, mesh.data()}),
        with.size());
    return with;
  }();
  return image;
}

// Verifies TS-IFC-010.
TEST(FixedPointImage, EndsInTheMeshOfTheTarget) {
  const Bytes& without = lasting_model_image<FixedPoint>(30);
  EXPECT_FALSE(surface_mesh_of<FixedPoint>(without.data()).is_known());
  EXPECT_FALSE(surface_mesh_of<Float32>(good_image().data()).is_known()) << "has no such section";
  const Bytes& image = image_of_tetrahedron();
  ASSERT_EQ(read_fixed(image), ModelStatus::kOk);
  EXPECT_TRUE(std::equal(image.begin() + kFixedData, image.end() - SurfaceMesh::kMaxBytes,
                         without.begin() + kFixedData))
      << "weights, and no points";
  const Bytes section = tetrahedron();
  EXPECT_TRUE(std::equal(section.begin(), section.end(), image.end() - SurfaceMesh::kMaxBytes));
  const SurfaceMesh mesh = surface_mesh_of<FixedPoint>(image.data());
  EXPECT_TRUE(mesh.is_known());
  EXPECT_EQ(mesh.vertices(), 4);
  EXPECT_EQ(mesh.triangles(), 4);
  EXPECT_EQ(mesh.edges(), 6);
  EXPECT_EQ(mesh.error_mm(), 37);
  EXPECT_EQ(mesh.vertex(3), (SurfaceMesh::Vertex{-10000, -20000, -10000}));
  EXPECT_EQ(mesh.triangle(3), (SurfaceMesh::Triangle{1, 3, 2}));
  EXPECT_EQ(mesh.edge(5).first, 2);
  EXPECT_EQ(mesh.edge(5).opposite, (std::array<std::int32_t, 2>{0, 1}));
}

// Verifies TS-IFC-040.
TEST(FixedPointImage, WithAnImpossibleMeshIsRefused) {
  struct Change {
    const char* what;
    std::size_t at;  // in the section
    std::uint16_t value;
    ModelStatus expected;
  };
  const std::size_t triangles = 8 + 6 * 4, edges = triangles + 6 * 4;
  std::vector<Change> changes = {
      {"vertices: one too few for the triangles", 0, 3, ModelStatus::kBadValue},
      {"too many vertices", 0, 4097, ModelStatus::kBadValue},
      {"too many triangles", 2, 6145, ModelStatus::kBadValue},
      {"a triangle less leaves the last edge behind the data", 2, 3, ModelStatus::kBadValue},
      {"too many edges", 4, 8193, ModelStatus::kBadValue},
      {"an edge less leaves the last one behind the data", 4, 5, ModelStatus::kBadValue},
      {"any error", 6, 65535, ModelStatus::kOk},
      {"any place of a vertex", 8, 0x8000, ModelStatus::kOk},
      {"the byte behind the data", kTetrahedronEnd, 1, ModelStatus::kBadValue},
      {"the middle of the zeros", 64'000, 0x0100, ModelStatus::kBadValue},
      {"the last byte", SurfaceMesh::kMaxBytes - 2, 0x8000, ModelStatus::kBadValue},
  };
  for (std::size_t at = triangles; at < kTetrahedronEnd; at += 2) {
    const char* const what = at < edges ? "corner of a triangle" : "corner of an edge";
    changes.push_back({what, at, 3, ModelStatus::kOk});
    changes.push_back({what, at, 4, ModelStatus::kBadValue});
    changes.push_back({what, at, 65535, ModelStatus::kBadValue});
  }
  Bytes image = image_of_tetrahedron();
  const std::size_t start = offset_of(image, kMesh);
  for (const Change& change : changes) {
    std::uint8_t* const bytes = image.data() + start + change.at;
    const std::array<std::uint8_t, 2> before{bytes[0], bytes[1]};
    bytes[0] = static_cast<std::uint8_t>(change.value & 255U);
    bytes[1] = static_cast<std::uint8_t>(change.value >> 8U);
    seal_section(image, kMesh);
    EXPECT_EQ(read_fixed(image), change.expected) << change.what << " at " << change.at;
    std::copy(before.begin(), before.end(), bytes);
  }
  seal_section(image, kMesh);
  EXPECT_EQ(read_fixed(image), ModelStatus::kOk);
}

// Verifies TS-IFC-020.
TEST(FixedPointImage, WithAFlippedBitAnywhereInItsMeshIsRefused) {
  Bytes image = image_of_tetrahedron();
  const std::size_t start = offset_of(image, kMesh);
  std::vector<std::size_t> places;
  for (std::size_t at = 0; at < kTetrahedronEnd + 4; ++at) places.push_back(at);
  for (std::size_t at = 5003; at < SurfaceMesh::kMaxBytes; at += 5003) places.push_back(at);
  places.push_back(SurfaceMesh::kMaxBytes - 1);
  for (const std::size_t at : places) {
    const auto bit = static_cast<std::uint8_t>(1U << (at % 8));
    image[start + at] ^= bit;
    EXPECT_EQ(read_fixed(image), ModelStatus::kBadSectionCrc) << at;
    image[start + at] ^= bit;
  }
}

// Verifies TS-IFC-010, TS-MEM-080.
TEST(FixedPointImage, LeavesItsWeightsInPlace) {
  const Bytes& image = lasting_model_image<FixedPoint>(30);
  ModelHeader header;
  auto weights = std::make_unique<NetworkWeights<FixedPoint>>();
  ASSERT_EQ(read_model_image<FixedPoint>(image.data(), image.size(), "test_craft", header, *weights),
            ModelStatus::kOk);
  EXPECT_EQ(static_cast<const void*>(layer_weights<0>(*weights).weight.data()), image.data() + kFixedData);
  Bytes again(image.size());
  ASSERT_EQ(write_model_image<FixedPoint>(header, *weights, again.data(), again.size()), image.size());
  EXPECT_TRUE(std::equal(image.begin() + kFixedData, image.end(), again.begin() + kFixedData));
}

// Verifies TS-IFC-040.
TEST(FixedPointImage, IsRefusedIfAShiftIsOutOfRange) {
  ASSERT_EQ(read_fixed(random_model_image<FixedPoint>(31)), ModelStatus::kOk);
  for (const int section : {2, 20, 24}) {  // conv1, cnn_out, lstm
    for (const std::uint32_t shift : {0U, 63U, 255U, 0xFFFFFFFFU}) {
      Bytes image = random_model_image<FixedPoint>(31);
      put_u32(image, offset_of(image, section), shift);
      seal_section(image, section);
      EXPECT_EQ(read_fixed(image), ModelStatus::kBadValue) << section << ' ' << shift;
    }
  }
  Bytes image = random_model_image<FixedPoint>(31);
  put_u32(image, offset_of(image, 2), 31);  // for an activation at most 30
  seal_section(image, 2);
  EXPECT_EQ(read_fixed(image), ModelStatus::kBadValue);
}

TEST(FixedPointImage, MayHaveShiftsUpTo62ForOutputsAndGates) {
  for (const int section : {20, 24}) {  // cnn_out, lstm
    for (const std::uint32_t shift : {1U, 31U, 32U, 62U}) {
      Bytes image = random_model_image<FixedPoint>(31);
      put_u32(image, offset_of(image, section), shift);
      seal_section(image, section);
      EXPECT_EQ(read_fixed(image), ModelStatus::kOk) << section << ' ' << shift;
    }
  }
}

// Verifies TS-IFC-040.
TEST(FixedPointImage, IsRefusedIfASumCouldLeave32Bits) {
  for (const int section : {1, 19, 23, 29}) {  // biases of conv1, cnn_out, lstm, head2
    for (const std::uint32_t bias : {0x7FFFFFFFU, 0x80000000U, 0x7FFF0000U}) {
      Bytes image = random_model_image<FixedPoint>(32);
      put_u32(image, offset_of(image, section), bias);
      seal_section(image, section);
      EXPECT_EQ(read_fixed(image), ModelStatus::kBadValue) << section << ' ' << bias;
    }
  }
  // Weights alone: 1440 inputs of up to 16380, each times 127.
  Bytes image = random_model_image<FixedPoint>(32);
  std::fill_n(image.begin() + static_cast<std::ptrdiff_t>(offset_of(image, 12)),
              get_u32(image, kTable + 16 * 12 + 8), 127);
  seal_section(image, 12);
  EXPECT_EQ(read_fixed(image), ModelStatus::kBadValue);
}

// Verifies TS-IFC-040.
TEST(FixedPointImage, IsRefusedIfTheDifferenceOfTwoSumsCouldLeave32Bits) {
  Bytes image = random_model_image<FixedPoint>(7);
  put_u32(image, offset_of(image, 1), 1U << 30);  // a bias of conv1
  seal_section(image, 1);
  EXPECT_EQ(read_fixed(image), ModelStatus::kBadValue);
}

// Verifies TS-IFC-040.
TEST(FixedPointImage, IsRefusedIfAWeightIsMinus128) {
  for (const int section : {0, 21, 22}) {  // conv1, lstm: forward and recurrent
    Bytes image = random_model_image<FixedPoint>(33);
    image[offset_of(image, section) + 5] = 0x80;
    seal_section(image, section);
    EXPECT_EQ(read_fixed(image), ModelStatus::kBadValue) << section;
  }
}

// Verifies TS-IFC-030.
TEST(ModelImage, IsAcceptedForAnyTargetWhenNoneIsExpected) {
  ModelHeader header;
  auto weights = std::make_unique<NetworkWeights<Float32>>();
  EXPECT_EQ(read_model_image<Float32>(good_image().data(), good_image().size(), nullptr, header, *weights),
            ModelStatus::kOk);
  EXPECT_STREQ(header.target.data(), "test_craft");
  EXPECT_EQ(read_model_image<Float32>(good_image().data(), good_image().size(), "", header, *weights),
            ModelStatus::kBadTarget);
  EXPECT_EQ(read_model_image<Float32>(nullptr, 0, nullptr, header, *weights), ModelStatus::kTooShort);
}

TEST(ModelImage, IsNotWrittenIntoTooSmallABuffer) {
  auto weights = std::make_unique<NetworkWeights<Float32>>();
  Bytes out(kModelImageSize<Float32> - 1, 0x55);
  EXPECT_EQ(write_model_image<Float32>(test_header(), *weights, out.data(), out.size()), 0U);
  EXPECT_EQ(out, Bytes(kModelImageSize<Float32> - 1, 0x55));
}

// Verifies TS-IFC-020.
TEST(ModelImage, IsRefusedAfterAnyBitFlipInHeaderOrSectionTable) {
  Bytes image = good_image();
  ModelHeader header;
  auto weights = std::make_unique<NetworkWeights<Float32>>();
  for (std::size_t bit = 0; bit < 8 * kModelDataOffset<Float32>; ++bit) {
    image[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    ASSERT_NE(read_model_image<Float32>(image.data(), image.size(), nullptr, header, *weights),
              ModelStatus::kOk)
        << bit;
    image[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
  }
}

TEST(ModelHeader, AcceptsOnlyNamesThatTheReaderAccepts) {
  ModelHeader header = test_header();
  EXPECT_FALSE(set_target(header, ""));
  EXPECT_FALSE(set_target(header, std::string(32, 'a').c_str()));
  EXPECT_FALSE(set_target(header, "tab\tbed"));
  EXPECT_STREQ(header.target.data(), "test_craft");
  EXPECT_TRUE(set_target(header, std::string(31, 'a').c_str()));
}

// Verifies TS-IFC-050.
TEST(ModelStatus, HasADistinctTextForEveryValue) {
  std::vector<std::string> texts;
  // One value beyond the last: an unknown status has a text too.
  for (int i = 0; i <= static_cast<int>(ModelStatus::kBadNumerics) + 1; ++i) {
    texts.emplace_back(to_string(static_cast<ModelStatus>(i)));
  }
  std::sort(texts.begin(), texts.end());
  EXPECT_EQ(std::adjacent_find(texts.begin(), texts.end()), texts.end());
}

}  // namespace
}  // namespace tumblesight::gnc
