#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "sim/cli/arguments.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/model/model_file.hpp"
#include "sim/onnx/onnx_model.hpp"

namespace tumblesight::sim {
namespace {

struct ExportArguments {
  std::string model;
  std::string onnx;
};

constexpr const char* kUseOfTheModels =
    "For every frame: run the CNN on its depth image, predict the attitude from the\n"
    "frames before, and give both to the recurrent network. h_next and c_next are h\n"
    "and c of the next frame. The algebra between the two models is in\n"
    "gnc/rcnn/hypotheses.hpp and gnc/rcnn/attitude_track.hpp. The doc strings of the\n"
    "models describe every input and output.\n";

void require_a_name(const std::string& prefix) {
  if (!std::filesystem::path(prefix).filename().empty()) return;
  throw CLI::ValidationError("--onnx", "'" + prefix + "' is a folder; add the first part of the file names");
}

void export_model(const ExportArguments& arguments) {
  require_a_name(arguments.onnx);
  require_usable_files({{"--model", arguments.model}}, {{"--onnx", arguments.onnx + ".cnn.onnx"},
                                                        {"--onnx", arguments.onnx + ".recurrent.onnx"}});
  const auto model = read_float32_model(arguments.model);
  const OnnxFiles files = write_onnx_files(*model, arguments.onnx);
  fmt::print("\n  ONNX models of {} in float32, image {:08x}\n", model->header.target.data(),
             model->header.crc32);
  fmt::print("  {}, {} bytes: depth image -> features, hypotheses\n", full_path(files.cnn.path),
             files.cnn.size_bytes);
  fmt::print("  {}, {} bytes: input, state -> corrections, next state\n\n", full_path(files.recurrent.path),
             files.recurrent.size_bytes);
  fmt::print("{}\n", kUseOfTheModels);
}

}  // namespace

void add_export_command(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand("export", "Write a float32 model image as ONNX models");
  command->footer(std::string("\nWrites PREFIX.cnn.onnx and PREFIX.recurrent.onnx (opset 13).\n") +
                  kUseOfTheModels +
                  "\nExample\n"
                  "  tumblesight export --model out/near/near_shoemaker.float32.tsm \\\n"
                  "      --onnx out/near/near_shoemaker\n");
  add_float32_model_option(*command, arguments->model);
  command->add_option("--onnx", arguments->onnx, "first part of both file names")
      ->required()
      ->type_name("PREFIX");
  command->callback([arguments] { export_model(*arguments); });
}

}  // namespace tumblesight::sim
