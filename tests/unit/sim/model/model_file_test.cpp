#include "sim/model/model_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "gnc/rcnn/model_format.hpp"
#include "tests/support/former_model_image.hpp"
#include "tests/support/hostile_files.hpp"
#include "tests/support/sim_models.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tumblesight::sim {
namespace {

TEST(ModelFile, ThatIsNoModelImageIsRefusedByName) {
  try {
    (void)read_float32_model("/dev/null");
    FAIL() << "an empty file was accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/null"), std::string::npos);
  }
}

TEST(ModelFile, IsRefusedUnreadIfItIsNoFileOrLargerThanAnImage) {
  expect_all_refused(".tsm", [](const std::string& path) { (void)read_float32_model(path); });
  expect_all_refused(".tsm", [](const std::string& path) { (void)read_fixed_point_header(path); });
  const HostileFiles hostile(".tsm");
  for (const HostileFile& file : hostile.files()) {
    const std::string fault = fault_of_model_path(file.path);
    EXPECT_EQ(fault.find(file.path) == std::string::npos, file.kind == "empty") << file.kind << fault;
  }
}

TEST(ModelFile, IsReadBackAsWritten) {
  const TemporaryFolder folder;
  const std::string path = folder.path("float32.tsm");
  const auto model = random_float32_model(77);
  const std::uint32_t crc32 = write_model_file<gnc::Float32>(path, model->header, model->weights);
  const auto read_back = read_float32_model(path);
  EXPECT_EQ(read_back->header.crc32, crc32);
  EXPECT_EQ(gnc::layer_weights<0>(read_back->weights).weight, gnc::layer_weights<0>(model->weights).weight);
}

// The user's own files beside it and links stay what they are.
TEST(ModelFile, IsWrittenAsAWholeAndThroughLinks) {
  const TemporaryFolder folder;
  const auto model = random_float32_model(77);
  std::ofstream(folder.path("m.tsm.new")) << "mine";
  std::filesystem::create_symlink(folder.path("real.tsm"), folder.path("m.tsm"));
  (void)write_model_file<gnc::Float32>(folder.path("m.tsm"), model->header, model->weights);
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path("m.tsm")));
  EXPECT_NO_THROW((void)read_float32_model(folder.path("real.tsm")));
  EXPECT_EQ(std::filesystem::file_size(folder.path("m.tsm.new")), 4U);
}

TEST(ModelFile, IsNotWrittenIfThereCanBeNoFolderOrTheReaderWouldRefuseIt) {
  const TemporaryFolder folder;
  const auto model = random_float32_model(77);
  EXPECT_THROW(write_model_file<gnc::Float32>("/dev/null/x.tsm", model->header, model->weights),
               std::runtime_error);
  gnc::layer_weights<0>(model->weights).bias[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(write_model_file<gnc::Float32>(folder.path("nan.tsm"), model->header, model->weights),
               std::runtime_error);
}

constexpr std::size_t kPointsBytes = gnc::SurfaceModel::kBytes, kMeshBytes = gnc::SurfaceMesh::kMaxBytes;

// `triangles` times the same one, each with its vertices.
SurfaceSections surface_of(std::uint32_t points, int triangles) {
  SurfaceSections surface;
  surface.points.assign(kPointsBytes, 7);
  gnc::model_format::put_u32(surface.points.data(), points);
  surface.mesh.resize(8 + 24 * static_cast<std::size_t>(triangles));
  gnc::model_format::put_u16(surface.mesh.data(), static_cast<std::uint16_t>(3 * triangles));
  gnc::model_format::put_u16(surface.mesh.data() + 2, static_cast<std::uint16_t>(triangles));
  return surface;
}

void write_bytes(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

TEST(ModelFile, GetsASurfaceAndKeepsItsWeights) {
  const TemporaryFolder folder;
  const std::string from = folder.path("without.tsm"), path = folder.path("with.tsm");
  const std::vector<std::uint8_t> today = gnc::random_model_image<gnc::FixedPoint>(3);
  for (const int version : {3, 4, 5}) {
    SCOPED_TRACE(version);
    write_bytes(from, version == 5 ? today : gnc::former_model_image(version, today));
    const SurfaceSections surface = surface_of(2000, 5);
    const std::uint32_t crc32 = write_with_surface(from, surface, path);
    const std::vector<std::uint8_t> image = read_model_bytes(path);
    EXPECT_EQ(read_fixed_point_header(path).crc32, crc32);
    EXPECT_EQ(image.size(), today.size());
    EXPECT_EQ(image[4], 5) << "format version";
    EXPECT_TRUE(std::equal(today.begin() + gnc::kModelDataOffset<gnc::FixedPoint>,
                           today.end() - kMeshBytes - kPointsBytes,
                           image.begin() + gnc::kModelDataOffset<gnc::FixedPoint>));
    EXPECT_TRUE(
        std::equal(surface.points.begin(), surface.points.end(), image.end() - kMeshBytes - kPointsBytes));
    EXPECT_TRUE(std::equal(surface.mesh.begin(), surface.mesh.end(), image.end() - kMeshBytes));
    EXPECT_EQ(gnc::surface_mesh_of<gnc::FixedPoint>(image.data()).triangles(), 5);
  }
  // Another surface in its place, with fewer triangles: nothing of the first one stays behind them.
  (void)write_with_surface(path, surface_of(1000, 2), from);
  const std::vector<std::uint8_t> image = read_model_bytes(from);
  EXPECT_EQ(gnc::surface_of<gnc::FixedPoint>(image.data()).points(), 1000U);
  EXPECT_EQ(gnc::surface_mesh_of<gnc::FixedPoint>(image.data()).triangles(), 2);
  EXPECT_EQ(std::count(image.end() - kMeshBytes + 8 + 24 * 2, image.end(), 0),
            static_cast<std::ptrdiff_t>(kMeshBytes - 8 - 24 * 2));
}

TEST(ModelFile, IsWrittenWithTheSurfaceInFixedPoint) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> from = gnc::random_model_image<gnc::FixedPoint>(3);
  gnc::ModelHeader header;
  const auto weights = std::make_unique<gnc::NetworkWeights<gnc::FixedPoint>>();
  ASSERT_EQ(gnc::read_model_image<gnc::FixedPoint>(from.data(), from.size(), nullptr, header, *weights),
            gnc::ModelStatus::kOk);
  const std::string path = folder.path("m.tsm");
  (void)write_model_file<gnc::FixedPoint>(path, header, *weights, surface_of(1500, 3));
  const std::vector<std::uint8_t> image = read_model_bytes(path);
  EXPECT_EQ(gnc::surface_of<gnc::FixedPoint>(image.data()).points(), 1500U);
  EXPECT_EQ(gnc::surface_mesh_of<gnc::FixedPoint>(image.data()).triangles(), 3);
  // What the reader would refuse, and sections that are none.
  SurfaceSections broken = surface_of(1500, 3);
  gnc::model_format::put_u16(broken.mesh.data(), 0);
  gnc::model_format::put_u16(broken.mesh.data() + 30, 9);
  EXPECT_THROW((void)write_model_file<gnc::FixedPoint>(path, header, *weights, broken), std::runtime_error);
  broken = surface_of(1500, 3);
  broken.mesh.resize(kMeshBytes + 1);
  EXPECT_THROW((void)write_model_file<gnc::FixedPoint>(path, header, *weights, broken),
               std::invalid_argument);
  broken = surface_of(1500, 3);
  broken.points.pop_back();
  EXPECT_THROW((void)write_model_file<gnc::FixedPoint>(path, header, *weights, broken),
               std::invalid_argument);
  EXPECT_EQ(read_model_bytes(path), image) << "the file is as it was";
}

TEST(ModelFile, OfAnEarlierFormatVersionIsReadWithoutTheSectionsThatItLacks) {
  const TemporaryFolder folder;
  const std::string path = folder.path("old.tsm");
  const std::vector<std::uint8_t> without = gnc::random_model_image<gnc::FixedPoint>(3);
  write_bytes(path, gnc::former_model_image(3, without));
  EXPECT_EQ(read_model_bytes(path), without);

  const std::string with = folder.path("with.tsm");
  write_bytes(with, without);
  (void)write_with_surface(with, {surface_of(2000, 1).points, {}}, with);
  const std::vector<std::uint8_t> expected = read_model_bytes(with);
  ASSERT_NE(expected, without);
  write_bytes(path, gnc::former_model_image(4, expected));
  EXPECT_EQ(read_model_bytes(path), expected);
}

TEST(ModelFile, OfAnEarlierFormatVersionIsStillCheckedForDamage) {
  const TemporaryFolder folder;
  const std::string path = folder.path("old.tsm");
  for (const int version : {3, 4}) {
    SCOPED_TRACE(version);
    const std::vector<std::uint8_t> old =
        gnc::former_model_image(version, gnc::random_model_image<gnc::FixedPoint>(3));
    std::vector<std::uint8_t> damaged = old;
    damaged.back() ^= 1;  // a weight, or a byte of the points
    write_bytes(path, damaged);
    EXPECT_THROW((void)read_fixed_point_header(path), std::runtime_error);
    damaged = old;
    damaged[17] ^= 1;  // the target's name
    write_bytes(path, damaged);
    EXPECT_EQ(read_model_bytes(path), damaged) << "not repaired";
    EXPECT_THROW((void)read_fixed_point_header(path), std::runtime_error);
  }
}

TEST(ModelFile, InFloat32GetsNoSurface) {
  const TemporaryFolder folder;
  const std::string path = folder.path("float32.tsm");
  const auto model = random_float32_model(77);
  (void)write_model_file<gnc::Float32>(path, model->header, model->weights);
  EXPECT_THROW((void)write_with_surface(path, {}, folder.path("out.tsm")), std::runtime_error);
}

TEST(ModelFile, ThatIsMissingOrAFolderIsRefusedByName) {
  for (const char* path : {"/nonexistent/x.tsm", "/tmp"}) {
    try {
      (void)read_model_bytes(path);
      FAIL() << path;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace tumblesight::sim
