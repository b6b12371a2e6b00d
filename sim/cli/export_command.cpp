#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sim/cli/arguments.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/model/model_file.hpp"
#include "sim/onnx/onnx_files.hpp"

namespace tumblesight::sim {
namespace {

struct ExportArguments {
  std::string model;
  std::string onnx;
};

constexpr const char* kUseOfTheModels =
    "For every frame: run the image model on the target's returns, then the step on\n"
    "its outputs. next_state is the state of the next frame. docs/onnx.md explains\n"
    "it and has examples in Python and JavaScript; the doc strings of the models\n"
    "describe every input and output. cnn and recurrent are the step's network in\n"
    "two parts, for tools that measure or convert networks.\n";

// One line per file, for help texts.
std::string explanations() {
  std::string text;
  for (const OnnxFileRow& row : onnx_file_rows())
    text += fmt::format("  {:<22}{}\n", onnx_path("PREFIX", row), row.explanation);
  return text;
}

void require_a_name(const std::string& prefix) {
  if (!std::filesystem::path(prefix).filename().empty()) return;
  throw ArgumentFault("--onnx", "'" + prefix + "' is a folder; add the first part of the file names");
}

void export_model(const ExportArguments& arguments) {
  require_a_name(arguments.onnx);
  OptionFiles outputs;
  for (const OnnxFileRow& row : onnx_file_rows())
    outputs.push_back({"--onnx", onnx_path(arguments.onnx, row)});
  require_usable_files({{"--model", arguments.model}}, outputs);
  const auto model = read_float32_model(arguments.model);
  const std::vector<OnnxFile> files = write_onnx_files(*model, arguments.onnx);
  fmt::print("\n  ONNX models of {} in float32, image {:08x}\n", model->header.target.data(),
             model->header.crc32);
  for (std::size_t i = 0; i < files.size(); ++i)
    fmt::print("  {}, {} bytes: {}\n", full_path(files[i].path), files[i].size_bytes,
               onnx_file_rows()[i].explanation);
  fmt::print("\n{}\n", kUseOfTheModels);
}

}  // namespace

void add_export_command(Command& app, const std::string&) {
  auto arguments = std::make_shared<ExportArguments>();
  Command command = add_verb(app, "export");
  command.footer("\nFiles (opset 13)\n" + explanations() + "\n" + kUseOfTheModels +
                 "\nExample\n"
                 "  tumblesight export --model out/near/near_shoemaker.float32.tsm \\\n"
                 "      --onnx out/near/near_shoemaker\n");
  add_float32_model_option(command, arguments->model);
  command.add_option("--onnx", arguments->onnx, "first part of the file names")
      ->required()
      ->type_name("PREFIX");
  command.callback([arguments] { export_model(*arguments); });
}

}  // namespace tumblesight::sim
