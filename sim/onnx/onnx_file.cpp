#include "sim/onnx/onnx_file.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "sim/onnx/onnx_model.hpp"

namespace tumblesight::sim {
namespace {

OnnxFile write_temporary(const std::string& path, const std::string& bytes) {
  std::ofstream out(path + ".new", std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) {
    std::error_code ignored;
    std::filesystem::remove(path + ".new", ignored);
    throw std::runtime_error("ONNX model '" + path + "' cannot be written");
  }
  return {path, bytes.size()};
}

}  // namespace

OnnxFiles write_onnx_files(const Float32Model& model, const std::string& prefix) {
  const OnnxFiles files{write_temporary(prefix + ".cnn.onnx", cnn_as_onnx(model)),
                        write_temporary(prefix + ".recurrent.onnx", recurrent_as_onnx(model))};
  for (const OnnxFile& file : {files.cnn, files.recurrent})
    std::filesystem::rename(file.path + ".new", file.path);
  return files;
}

}  // namespace tumblesight::sim
