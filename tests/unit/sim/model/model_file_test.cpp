#include "sim/model/model_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "gnc/rcnn/model_format.hpp"
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

// An image without the section, as format version 3 had it.
std::vector<std::uint8_t> of_version_3(std::vector<std::uint8_t> image) {
  using namespace gnc::model_format;
  constexpr std::uint32_t kTensors = 31;
  image.resize(image.size() - gnc::SurfaceModel::kBytes);
  put_u16(image.data() + kOffsetVersion, 3);
  put_u32(image.data() + kOffsetTotalSize, static_cast<std::uint32_t>(image.size()));
  put_u32(image.data() + kOffsetSectionCount, kTensors);
  std::fill_n(image.data() + gnc::kModelHeaderSize + kTensors * gnc::kModelSectionEntrySize,
              gnc::kModelSectionEntrySize, std::uint8_t{0});
  put_u32(image.data() + kOffsetHeaderCrc, header_crc(image.data(), kTensors));
  return image;
}

void write_bytes(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

TEST(ModelFile, GetsASurfaceAndKeepsItsWeights) {
  const TemporaryFolder folder;
  const std::string from = folder.path("without.tsm"), path = folder.path("with.tsm");
  const std::vector<std::uint8_t> old = of_version_3(gnc::random_model_image<gnc::FixedPoint>(3));
  write_bytes(from, old);
  std::vector<std::uint8_t> surface(gnc::SurfaceModel::kBytes, 7);
  gnc::model_format::put_u32(surface.data(), 2000);
  const std::uint32_t crc32 = write_with_surface(from, surface, path);
  const std::vector<std::uint8_t> image = read_model_bytes(path);
  EXPECT_EQ(read_fixed_point_header(path).crc32, crc32);
  EXPECT_EQ(image.size(), old.size() + surface.size());
  EXPECT_TRUE(std::equal(old.begin() + gnc::kModelDataOffset<gnc::FixedPoint>, old.end(),
                         image.begin() + gnc::kModelDataOffset<gnc::FixedPoint>));
  EXPECT_TRUE(std::equal(surface.begin(), surface.end(), image.end() - gnc::SurfaceModel::kBytes));
  // Another surface in its place.
  gnc::model_format::put_u32(surface.data(), 1000);
  (void)write_with_surface(path, surface, from);
  EXPECT_EQ(gnc::surface_of<gnc::FixedPoint>(read_model_bytes(from).data()).points(), 1000U);
}

TEST(ModelFile, OfFormatVersion3IsReadWithoutASurface) {
  const TemporaryFolder folder;
  const std::string path = folder.path("old.tsm");
  const std::vector<std::uint8_t> expected = gnc::random_model_image<gnc::FixedPoint>(3);
  write_bytes(path, of_version_3(expected));
  EXPECT_EQ(read_model_bytes(path), expected);
}

TEST(ModelFile, InFloat32GetsNoSurface) {
  const TemporaryFolder folder;
  const std::string path = folder.path("float32.tsm");
  const auto model = random_float32_model(77);
  (void)write_model_file<gnc::Float32>(path, model->header, model->weights);
  EXPECT_THROW((void)write_with_surface(path, std::vector<std::uint8_t>(gnc::SurfaceModel::kBytes),
                                        folder.path("out.tsm")),
               std::runtime_error);
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
