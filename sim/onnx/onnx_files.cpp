#include "sim/onnx/onnx_files.hpp"

#include "sim/host/write_file.hpp"
#include "sim/onnx/image_model.hpp"
#include "sim/onnx/onnx_model.hpp"
#include "sim/onnx/step_model.hpp"

namespace tumblesight::sim {

const std::vector<OnnxFileRow>& onnx_file_rows() {
  static const std::vector<OnnxFileRow> rows{
      {"image", "the target's returns -> depth image",
       [](const Float32Model& model) { return image_as_onnx(model.header); }},
      {"step", "depth image, time, turn, state -> attitude, next state", step_as_onnx},
      {"cnn", "part of the step: depth image -> features, hypotheses", cnn_as_onnx},
      {"recurrent", "part of the step: input, state -> corrections, next", recurrent_as_onnx},
  };
  return rows;
}

std::string onnx_path(const std::string& prefix, const OnnxFileRow& row) {
  return prefix + "." + row.name + ".onnx";
}

std::vector<OnnxFile> write_onnx_files(const Float32Model& model, const std::string& prefix) {
  std::vector<OnnxFile> files;
  for (const OnnxFileRow& row : onnx_file_rows()) {
    const std::string content = row.make(model);
    files.push_back({onnx_path(prefix, row), content.size()});
    write_file(files.back().path, content);
  }
  return files;
}

}  // namespace tumblesight::sim
