#include "sim/onnx/new_model.hpp"

#include <array>
#include <cstdio>

namespace tumblesight::sim {
namespace {

constexpr int kIrVersion = 8;
constexpr int kOpset = 13;

void add_metadata(onnx::ModelProto& model, const std::string& key, const std::string& value) {
  onnx::StringStringEntryProto& entry = *model.add_metadata_props();
  entry.set_key(key);
  entry.set_value(value);
}

}  // namespace

onnx::ModelProto new_model(const gnc::ModelHeader& header, const std::string& graph,
                           const std::string& description) {
  onnx::ModelProto model;
  model.set_ir_version(kIrVersion);
  onnx::OperatorSetIdProto& operators = *model.add_opset_import();
  operators.set_domain("");
  operators.set_version(kOpset);
  model.set_producer_name("Tumblesight");
  model.set_producer_version(TUMBLESIGHT_VERSION);
  model.set_doc_string(description);
  model.mutable_graph()->set_name(graph);
  std::array<char, 9> crc32{};
  std::snprintf(crc32.data(), crc32.size(), "%08x", static_cast<unsigned>(header.crc32));
  add_metadata(model, "target", header.target.data());
  add_metadata(model, "crc32", crc32.data());
  add_metadata(model, "swath_mm", std::to_string(header.projection.swath_mm));
  add_metadata(model, "target_radius_mm", std::to_string(header.projection.target_radius_mm));
  return model;
}

}  // namespace tumblesight::sim
