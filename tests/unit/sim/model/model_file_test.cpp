#include "sim/model/model_file.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

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

TEST(ModelFile, IsNotWrittenIfTheFolderIsMissingOrTheReaderWouldRefuseIt) {
  const TemporaryFolder folder;
  const auto model = random_float32_model(77);
  EXPECT_THROW(write_model_file<gnc::Float32>("/dev/null/x.tsm", model->header, model->weights),
               std::runtime_error);
  gnc::layer_weights<0>(model->weights).bias[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(write_model_file<gnc::Float32>(folder.path("nan.tsm"), model->header, model->weights),
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
