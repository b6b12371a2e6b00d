// The files of `tumblesight export` are valid ONNX of the network's sizes. Their outputs are checked in
// tests/unit/sim/bench/peer_test.cpp.
#include "sim/onnx/onnx_model.hpp"

#include <gtest/gtest.h>
#include <onnx/checker.h>
#include <onnx/onnx_pb.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <vector>

#include "tests/support/sim_models.hpp"

namespace tumblesight::sim {
namespace {

namespace shape = gnc::shape;
using Sizes = std::map<std::string, std::vector<std::int64_t>>;

std::unique_ptr<Float32Model> random_model() {
  auto model = random_float32_model(5);
  model->header.crc32 = 0x00abcdef;
  return model;
}

onnx::ModelProto parsed(const std::string& bytes) {
  onnx::ModelProto model;
  EXPECT_TRUE(model.ParseFromString(bytes));
  return model;
}

template <class Values>
Sizes sizes_of(const Values& values) {
  Sizes sizes;
  for (const onnx::ValueInfoProto& value : values) {
    EXPECT_FALSE(value.doc_string().empty()) << value.name();
    for (const auto& size : value.type().tensor_type().shape().dim())
      sizes[value.name()].push_back(size.dim_value());
  }
  return sizes;
}

std::size_t count_of_floats(const onnx::ModelProto& model) {
  std::size_t count = 0;
  for (const onnx::TensorProto& tensor : model.graph().initializer())
    count += tensor.raw_data().size() / sizeof(float);
  return count;
}

// Verifies TS-TRN-060.
TEST(OnnxModel, OfTheCnnIsValidAndHasItsSizes) {
  const onnx::ModelProto model = parsed(cnn_as_onnx(*random_model()));
  EXPECT_NO_THROW(onnx::checker::check_model(model));
  EXPECT_EQ(sizes_of(model.graph().input()),
            (Sizes{{"image", {1, 1, shape::kImageSide, shape::kImageSide}}}));
  EXPECT_EQ(sizes_of(model.graph().output()),
            (Sizes{{"features", {1, shape::kDense2}}, {"output", {1, shape::kOutput}}}));
}

// Verifies TS-TRN-060.
TEST(OnnxModel, OfTheRecurrentPartIsValidAndHasItsSizes) {
  const onnx::ModelProto model = parsed(recurrent_as_onnx(*random_model()));
  EXPECT_NO_THROW(onnx::checker::check_model(model));
  EXPECT_EQ(sizes_of(model.graph().input()),
            (Sizes{{"input", {1, shape::kLstmInput}}, {"h", {1, shape::kLstm}}, {"c", {1, shape::kLstm}}}));
  EXPECT_EQ(sizes_of(model.graph().output()), (Sizes{{"output", {1, shape::kHeadOutput}},
                                                     {"h_next", {1, shape::kLstm}},
                                                     {"c_next", {1, shape::kLstm}}}));
}

// Verifies TS-TRN-060.
TEST(OnnxModel, HoldsEveryParameterOnce) {
  const auto model = random_model();
  constexpr std::size_t kSecondBias = 4 * shape::kLstm;  // required by ONNX, all zero
  EXPECT_EQ(count_of_floats(parsed(cnn_as_onnx(*model))) + count_of_floats(parsed(recurrent_as_onnx(*model))),
            gnc::kParameterCount + kSecondBias);
}

TEST(OnnxModel, HasTheMetadataOfTheModelImage) {
  const onnx::ModelProto model = parsed(cnn_as_onnx(*random_model()));
  std::map<std::string, std::string> metadata;
  for (const auto& entry : model.metadata_props()) metadata[entry.key()] = entry.value();
  EXPECT_EQ(metadata, (std::map<std::string, std::string>{{"target", "test_craft"},
                                                          {"crc32", "00abcdef"},
                                                          {"swath_mm", "7500"},
                                                          {"target_radius_mm", "3250"}}));
}

TEST(OnnxFile, HoldsTheModelAndNoTemporaryFileRemains) {
  const auto model = random_model();
  const auto folder = std::filesystem::temp_directory_path() / (std::to_string(getpid()) + "_onnx");
  std::filesystem::create_directory(folder);
  const OnnxFiles files = write_onnx_files(*model, (folder / "near").string());
  std::ifstream file(folder / "near.cnn.onnx", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(bytes, cnn_as_onnx(*model));
  EXPECT_EQ(files.cnn.size_bytes, bytes.size());
  EXPECT_TRUE(std::filesystem::exists(files.recurrent.path));
  const auto entries = std::filesystem::directory_iterator(folder);
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 2);
  std::filesystem::remove_all(folder);
}

TEST(OnnxFile, ThatCannotBeWrittenIsNamedInTheError) {
  try {
    (void)write_onnx_files(*random_model(), "/dev/null/near");
    FAIL() << "a file was written into a folder that does not exist";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("'/dev/null'"), std::string::npos);
  }
}

}  // namespace
}  // namespace tumblesight::sim
