#include "sim/onnx/new_model.hpp"

#include <array>
#include <cstdio>
#include <utility>

#include "gnc/numerics/conversion.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kIrVersion = 8;
constexpr int kOpset = 13;

void add_metadata(onnx::ModelProto& model, const std::string& key, const std::string& value) {
  onnx::StringStringEntryProto& entry = *model.add_metadata_props();
  entry.set_key(key);
  entry.set_value(value);
}

constexpr const char* kPeriodText_s = "2.7";
static_assert(gnc::kNominalPeriod_ns == 2'700'000'000);
constexpr const char* kUnits =
    "metres, seconds, radians; *_mm in millimetres; inertia_trf: xx yy zz xy xz yz, scaled to a trace of 3";
constexpr const char* kFrames =
    "lrf: LiDAR, +x right, +y boresight, +z up; view: lrf turned by the shortest rotation that points its +y "
    "at the "
    "centroid of the returns; trf: target, the axes of its mesh. q_a_b and r_a_b take b to a: v_a = q_a_b "
    "v_b. "
    "Quaternions are unit, Hamilton, scalar first";

// "xx yy zz xy xz yz"
std::string elements_of(const gnc::Matrix3<gnc::Fixed>& inertia_trf) {
  std::string text;
  for (const auto& [row, column] : {std::pair(0, 0), std::pair(1, 1), std::pair(2, 2), std::pair(0, 1),
                                    std::pair(0, 2), std::pair(1, 2)}) {
    std::array<char, 32> number{};
    const auto value = static_cast<double>(gnc::converted<float>(inertia_trf(row, column)));
    std::snprintf(number.data(), number.size(), "%s%.7f", text.empty() ? "" : " ", value);
    text += number.data();
  }
  return text;
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
  add_metadata(model, "inertia_trf", elements_of(header.inertia.tensor_trf));
  add_metadata(model, "period_s", kPeriodText_s);
  add_metadata(model, "units", kUnits);
  add_metadata(model, "frames", kFrames);
  return model;
}

}  // namespace tumblesight::sim
