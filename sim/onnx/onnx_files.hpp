// The files of `tumblesight export`, in one table.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/model/model_file.hpp"

namespace tumblesight::sim {

struct OnnxFileRow {
  const char* name;         // the file is <prefix>.<name>.onnx
  const char* explanation;  // one line
  std::string (*make)(const Float32Model&);
};
// First the two to run, then the parts of the second.
const std::vector<OnnxFileRow>& onnx_file_rows();

std::string onnx_path(const std::string& prefix, const OnnxFileRow& row);

struct OnnxFile {
  std::string path;
  std::uint64_t size_bytes;
};
// Writes each file as a whole, in the order of the table. Throws std::runtime_error that names the file if
// one cannot be written.
std::vector<OnnxFile> write_onnx_files(const Float32Model& model, const std::string& prefix);

}  // namespace tumblesight::sim
