// The files of `tumblesight export` are valid ONNX of the network's sizes. Their outputs are checked in
// tests/unit/sim/bench: runtime_test.cpp and step_model_test.cpp.
#include "sim/onnx/onnx_model.hpp"

#include <gtest/gtest.h>
#include <onnx/checker.h>
#include <onnx/onnx_pb.h>
#include <onnx/shape_inference/implementation.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <vector>

#include "sim/onnx/image_model.hpp"
#include "sim/onnx/onnx_files.hpp"
#include "sim/onnx/step_model.hpp"
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
  for (const onnx::TensorProto& tensor : model.graph().initializer()) {
    if (tensor.data_type() == onnx::TensorProto::FLOAT) count += tensor.raw_data().size() / sizeof(float);
  }
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

// Verifies TS-TRN-070.
TEST(OnnxModel, OfTheStepIsValidAndHasItsSizes) {
  const onnx::ModelProto model = parsed(step_as_onnx(*random_model()));
  EXPECT_NO_THROW(onnx::checker::check_model(model));
  EXPECT_EQ(sizes_of(model.graph().input()), (Sizes{{"image", {1, 1, shape::kImageSide, shape::kImageSide}},
                                                    {"r_lrf_view", {1, 3, 3}},
                                                    {"elapsed_s", {1, 1}},
                                                    {"q_now_last", {1, 4}},
                                                    {"state", {1, kStepState}}}));
  EXPECT_EQ(sizes_of(model.graph().output()), (Sizes{{"q_lrf_trf", {1, 4}},
                                                     {"expected_error_rad", {1, 1}},
                                                     {"rate_lrf_rad_s", {1, 3}},
                                                     {"q_lrf_trf_hypotheses", {1, shape::kHypotheses, 4}},
                                                     {"probabilities", {1, shape::kHypotheses}},
                                                     {"next_state", {1, kStepState}}}));
  EXPECT_EQ(kStepState, 451) << "docs/onnx.md and docs/examples name it";
}

// Verifies TS-TRN-070.
TEST(OnnxModel, OfTheImageIsValidAndHasItsSizes) {
  const onnx::ModelProto model = parsed(image_as_onnx(random_model()->header));
  EXPECT_NO_THROW(onnx::checker::check_model(model));
  EXPECT_EQ(sizes_of(model.graph().input()), (Sizes{{"points_lrf_m", {0, 3}}})) << "any number of points";
  EXPECT_EQ(model.graph().input(0).type().tensor_type().shape().dim(0).dim_param(), "n");
  EXPECT_EQ(sizes_of(model.graph().output()), (Sizes{{"image", {1, 1, shape::kImageSide, shape::kImageSide}},
                                                     {"r_lrf_view", {1, 3, 3}},
                                                     {"distance_m", {1, 1}}}));
}

// Verifies TS-TRN-070.
TEST(OnnxModel, TypesAndSizesOfAllValuesFollowFromTheInputs) {
  const auto random = random_model();
  for (const OnnxFileRow& row : onnx_file_rows()) {
    onnx::ModelProto model = parsed(row.make(*random));
    const Sizes stated = sizes_of(model.graph().output());
    for (auto& output : *model.mutable_graph()->mutable_output()) output.mutable_type()->Clear();
    const onnx::ShapeInferenceOptions strict(true, 1, true);
    EXPECT_NO_THROW(onnx::shape_inference::InferShapes(model, onnx::OpSchemaRegistry::Instance(), strict));
    EXPECT_EQ(sizes_of(model.graph().output()), stated) << row.name;
  }
}

void add_operators(const onnx::GraphProto& graph, std::set<std::string>& domains,
                   std::set<std::string>& names) {
  for (const onnx::NodeProto& node : graph.node()) {
    domains.insert(node.domain());
    EXPECT_TRUE(names.insert(node.name()).second) << node.name();
    for (const auto& attribute : node.attribute()) {
      if (attribute.has_g()) add_operators(attribute.g(), domains, names);
    }
  }
}

// Verifies TS-TRN-070.
TEST(OnnxModel, UsesTheStandardOperatorsOfOpset13) {
  const auto random = random_model();
  for (const OnnxFileRow& row : onnx_file_rows()) {
    const onnx::ModelProto model = parsed(row.make(*random));
    ASSERT_EQ(model.opset_import_size(), 1) << row.name;
    EXPECT_EQ(model.opset_import(0).domain(), "") << row.name;
    EXPECT_EQ(model.opset_import(0).version(), 13) << row.name;
    std::set<std::string> domains, names;
    add_operators(model.graph(), domains, names);
    EXPECT_EQ(domains, std::set<std::string>{""}) << row.name;
  }
}

// Verifies TS-TRN-060.
TEST(OnnxModel, HoldsEveryParameterOnce) {
  const auto model = random_model();
  constexpr std::size_t kSecondBias = 4 * shape::kLstm;  // required by ONNX, all zero
  EXPECT_EQ(count_of_floats(parsed(cnn_as_onnx(*model))) + count_of_floats(parsed(recurrent_as_onnx(*model))),
            gnc::kParameterCount + kSecondBias);
}

// Verifies TS-TRN-070.
TEST(OnnxModel, HasTheMetadataOfTheModelImage) {
  const auto random = random_model();
  random->header.inertia.tensor_trf << gnc::Fixed(0.75), gnc::Fixed(0.0625), gnc::Fixed(-0.125),  //
      gnc::Fixed(0.0625), gnc::Fixed(1.0), gnc::Fixed(0.0),                                       //
      gnc::Fixed(-0.125), gnc::Fixed(0.0), gnc::Fixed(1.25);
  const onnx::ModelProto model = parsed(step_as_onnx(*random));
  std::map<std::string, std::string> metadata;
  for (const auto& entry : model.metadata_props()) metadata[entry.key()] = entry.value();
  for (const char* in_words : {"units", "frames"}) EXPECT_FALSE(metadata[in_words].empty()) << in_words;
  metadata.erase("units");
  metadata.erase("frames");
  EXPECT_EQ(metadata,
            (std::map<std::string, std::string>{{"target", "test_craft"},
                                                {"crc32", "00abcdef"},
                                                {"swath_mm", "7500"},
                                                {"target_radius_mm", "3250"},
                                                {"inertia_trf",
                                                 "0.7500000 1.0000000 1.2500000 0.0625000 -0.1250000 "
                                                 "0.0000000"},
                                                {"period_s", "2.7"}}));
}

TEST(OnnxFile, HoldsTheModelAndNoTemporaryFileRemains) {
  const auto model = random_model();
  const auto folder = std::filesystem::temp_directory_path() / (std::to_string(getpid()) + "_onnx");
  std::filesystem::create_directory(folder);
  const std::vector<OnnxFile> files = write_onnx_files(*model, (folder / "near").string());
  ASSERT_EQ(files.size(), 4U);
  std::ifstream file(folder / "near.step.onnx", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(bytes, step_as_onnx(*model));
  EXPECT_EQ(files[1].path, (folder / "near.step.onnx").string());
  EXPECT_EQ(files[1].size_bytes, bytes.size());
  for (const OnnxFile& other : files) EXPECT_TRUE(std::filesystem::exists(other.path)) << other.path;
  const auto entries = std::filesystem::directory_iterator(folder);
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 4);
  std::filesystem::remove_all(folder);
}

TEST(OnnxFile, ThatCannotBeWrittenIsNamedInTheError) {
  try {
    (void)write_onnx_files(*random_model(), "/dev/null/near");
    FAIL() << "a file was written into a folder that does not exist";
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.rfind("cannot write '/dev/null/near", 0), 0U) << text;
    EXPECT_NE(text.find("'null' of its path cannot be entered"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace tumblesight::sim
