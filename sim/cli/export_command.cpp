#include "sim/cli/export_command.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "sim/cli/arguments.hpp"
#include "sim/model/model_file.hpp"
#include "sim/onnx/onnx_file.hpp"

namespace tumblesight::sim {
namespace {

struct ExportArguments {
  std::string model;
  std::string onnx;
};

constexpr const char* kHowTheyGoTogether =
    "For every frame: its depth image through the CNN; the attitude predicted from the frames before;\n"
    "both into the recurrent network's input; h_next and c_next are h and c of the next frame. The\n"
    "algebra between the two is gnc/rcnn/hypotheses.hpp and gnc/rcnn/attitude_track.hpp; the models' doc\n"
    "strings say what each number means.\n";

void require_a_name(const std::string& prefix) {
  if (!std::filesystem::path(prefix).filename().empty()) return;
  throw CLI::ValidationError("--onnx",
                             "'" + prefix + "' is a folder; what the files' names begin with is missing");
}

void export_model(const ExportArguments& arguments) {
  require_a_name(arguments.onnx);
  const auto model = read_float32_model(arguments.model);
  const OnnxFiles files = write_onnx_files(*model, arguments.onnx);
  fmt::print("\n  ONNX models of {} in float32, image {:08x}\n", model->header.target.data(),
             model->header.crc32);
  fmt::print("  {}, {} bytes: depth image -> features, hypotheses\n", full_path(files.cnn.path),
             files.cnn.size_bytes);
  fmt::print("  {}, {} bytes: input, state -> corrections, next state\n\n", full_path(files.recurrent.path),
             files.recurrent.size_bytes);
  fmt::print("{}\n", kHowTheyGoTogether);
}

}  // namespace

void add_export_command(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand("export", "Write a float32 model image as ONNX models");
  command->footer(
      std::string("\nWrites PREFIX.cnn.onnx and PREFIX.recurrent.onnx (opset 13).\n") + kHowTheyGoTogether +
      "\nExample\n"
      "  tumblesight export --model out/near/near_shoemaker.float32.tsm --onnx out/near/near_shoemaker\n");
  command->add_option("--model", arguments->model, "Model image in float32, as `tumblesight train` writes it")
      ->required()
      ->check(existing_model_image())
      ->type_name("FILE");
  command->add_option("--onnx", arguments->onnx, "What the names of both files begin with")
      ->required()
      ->type_name("PREFIX");
  command->callback([arguments] { export_model(*arguments); });
}

}  // namespace tumblesight::sim
