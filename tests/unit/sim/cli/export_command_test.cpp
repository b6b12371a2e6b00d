// `tumblesight export`: its files, its output and its refusals.
#include <gtest/gtest.h>

#include "tests/support/test_models.hpp"
#include "tests/unit/sim/cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

std::string float32_model(const Workplace& here) {
  const std::vector<std::uint8_t> image = gnc::random_model_image<gnc::Float32>(3);
  std::ofstream file(here.path("x.float32.tsm"), std::ios::binary);
  file.write(reinterpret_cast<const char*>(image.data()), static_cast<std::streamsize>(image.size()));
  return here.path("x.float32.tsm");
}

TEST(Export, WritesTheModelsAndNamesThem) {
  const Workplace here;
  const Outcome outcome = here.run("export --model " + float32_model(here) + " --onnx net");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  for (const char* name : {"net.image.onnx", "net.step.onnx", "net.cnn.onnx", "net.recurrent.onnx"}) {
    EXPECT_GT(content(here.path(name)).size(), 3'000U) << name;
    EXPECT_NE(outcome.output.find(name), std::string::npos) << outcome.output;
  }
}

TEST(Export, CreatesTheFolder) {
  const Workplace here;
  const Outcome outcome = here.run("export --model " + float32_model(here) + " --onnx new/folder/net");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_FALSE(content(here.path("new/folder/net.cnn.onnx")).empty());
}

TEST(Export, RefusesFixedPointAFolderAndAnImpossibleFolder) {
  const Workplace here;
  const std::string model = float32_model(here);
  const Outcome fixed = here.run("export --model " + here.model() + " --onnx net");
  EXPECT_EQ(fixed.exit_code, 1);
  EXPECT_NE(fixed.errors.find("model.tsm' is in fixed point; give the one in float32"), std::string::npos)
      << fixed.errors;
  const Outcome folder = here.run("export --model " + model + " --onnx ./");
  EXPECT_EQ(folder.exit_code, 2);
  EXPECT_NE(folder.errors.find("--onnx: './' is a folder"), std::string::npos) << folder.errors;
  const Outcome nowhere = here.run("export --model " + model + " --onnx /proc/none/net");
  EXPECT_EQ(nowhere.exit_code, 1);
  EXPECT_NE(nowhere.errors.find("--onnx /proc/none/net.image.onnx: cannot create its folder"),
            std::string::npos)
      << nowhere.errors;
}

}  // namespace
}  // namespace tumblesight::sim
