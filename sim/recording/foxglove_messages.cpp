#include "sim/recording/foxglove_messages.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "hal/messages/event_text.hpp"
#include "sim/recording/run_step.hpp"
#include "sim/recording/viewed_frame.hpp"

namespace tumblesight::sim {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kLrf = "lrf";
constexpr double kDegrees = 180.0 / M_PI;
constexpr int kFloat32 = 7;                     // foxglove.NumericType
constexpr std::array<int, 3> kLevels{2, 3, 4};  // foxglove.LogLevel by hal::Severity
constexpr std::size_t kFloatBytes = sizeof(float), kPointFloats = 3;

Json timestamp(std::int64_t time_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  return {{"sec", time_ns / kSecond_ns}, {"nsec", time_ns % kSecond_ns}};
}

Json vector(const Eigen::Vector3d& v) {
  return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}};
}

Json quaternion(const Eigen::Quaterniond& q) {
  return {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}};
}

Json transform(const char* child, const PoseInLrf& pose, std::int64_t time_ns) {
  return {{"timestamp", timestamp(time_ns)},
          {"parent_frame_id", kLrf},
          {"child_frame_id", child},
          {"translation", vector(pose.origin_lrf_m)},
          {"rotation", quaternion(pose.q_lrf_trf)}};
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) three = (three << 8) | (i + k < bytes.size() ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : kDigits[(three >> (18 - 6 * k)) & 63];
  }
  return text;
}

// A recording's truth may be of the attitude alone.
bool is_known(double value) {
  return std::isfinite(value);
}

double angle_deg(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return kDegrees * a.angularDistance(b);
}

}  // namespace

const FoxgloveSchema& point_cloud_schema() {
  static const FoxgloveSchema schema{"foxglove.PointCloud", R"({"type":"object","properties":{
"timestamp":{"type":"object","properties":{"sec":{"type":"integer"},"nsec":{"type":"integer"}}},
"frame_id":{"type":"string"},
"pose":{"type":"object","properties":{
"position":{"type":"object","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}}},
"orientation":{"type":"object","properties":{
"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"},"w":{"type":"number"}}}}},
"point_stride":{"type":"integer"},
"fields":{"type":"array","items":{"type":"object","properties":{
"name":{"type":"string"},"offset":{"type":"integer"},"type":{"type":"integer"}}}},
"data":{"type":"string","contentEncoding":"base64"}}})"};
  return schema;
}

const FoxgloveSchema& transforms_schema() {
  static const FoxgloveSchema schema{"foxglove.FrameTransforms", R"({"type":"object","properties":{
"transforms":{"type":"array","items":{"type":"object","properties":{
"timestamp":{"type":"object","properties":{"sec":{"type":"integer"},"nsec":{"type":"integer"}}},
"parent_frame_id":{"type":"string"},"child_frame_id":{"type":"string"},
"translation":{"type":"object","properties":{
"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}}},
"rotation":{"type":"object","properties":{
"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"},"w":{"type":"number"}}}}}}}})"};
  return schema;
}

const FoxgloveSchema& log_schema() {
  static const FoxgloveSchema schema{"foxglove.Log", R"({"type":"object","properties":{
"timestamp":{"type":"object","properties":{"sec":{"type":"integer"},"nsec":{"type":"integer"}}},
"level":{"type":"integer"},"message":{"type":"string"},"name":{"type":"string"},"file":{"type":"string"},
"line":{"type":"integer"}}})"};
  return schema;
}

const FoxgloveSchema& figures_schema() {
  static const FoxgloveSchema schema{"tumblesight.Figures", R"({"type":"object","properties":{
"network_error_deg":{"type":"number"},"network_expected_error_deg":{"type":"number"},
"pose_error_deg":{"type":"number"},"pose_sigma_deg":{"type":"number"},
"true_range_m":{"type":"number"},"pose_range_m":{"type":"number"},
"true_rate_deg_s":{"type":"number"},"pose_rate_deg_s":{"type":"number"},
"valid":{"type":"boolean"},"verified":{"type":"boolean"}}})"};
  return schema;
}

std::string point_cloud_json(const gnc::RangeImage& frame, std::int64_t time_ns) {
  Json fields = Json::array();
  for (std::size_t i = 0; i < kPointFloats; ++i)
    fields.push_back({{"name", std::string(1, "xyz"[i])}, {"offset", i * kFloatBytes}, {"type", kFloat32}});
  return Json{{"timestamp", timestamp(time_ns)},
              {"frame_id", kLrf},
              {"pose",
               {{"position", vector(Eigen::Vector3d::Zero())},
                {"orientation", quaternion(Eigen::Quaterniond::Identity())}}},
              {"point_stride", kPointFloats * kFloatBytes},
              {"fields", fields},
              {"data", base64(point_bytes(frame, PointFields::kXyz))}}
      .dump();
}

std::string transforms_json(const hal::AttitudeReport& report, const FrameTruth* truth, double swath_m,
                            std::int64_t time_ns) {
  Json transforms = Json::array();
  if (truth != nullptr && is_known(truth->range_m)) {
    const Eigen::Vector3d origin_m(swath_m * truth->offset_swaths.x(), truth->range_m,
                                   swath_m * truth->offset_swaths.y());
    transforms.push_back(transform("target_true", {truth->q_lrf_trf, origin_m}, time_ns));
  }
  if (const auto pose = network_pose(report))
    transforms.push_back(transform("target_network", *pose, time_ns));
  if (const auto pose = registered_pose(report))
    transforms.push_back(transform("target_pose", *pose, time_ns));
  return Json{{"transforms", transforms}}.dump();
}

std::string log_json(const hal::Event& event, std::int64_t time_ns) {
  const auto& a = event.arguments;
  const std::string message = std::string(text_of(event.id)) + " [" + std::to_string(a[0]) + ", " +
                              std::to_string(a[1]) + ", " + std::to_string(a[2]) + "]";
  return Json{{"timestamp", timestamp(time_ns)},
              {"level", kLevels[std::min(static_cast<std::size_t>(event.severity), kLevels.size() - 1)]},
              {"message", message},
              {"name", "flight"},
              {"file", ""},
              {"line", 0}}
      .dump();
}

std::string figures_json(const hal::AttitudeReport& report, const FrameTruth* truth) {
  Json figures{{"valid", report.validity == hal::Validity::kValid},
               {"verified", gives_attitude(report) && report.pose_doubts == 0}};
  const std::optional<PoseInLrf> network = network_pose(report), registered = registered_pose(report);
  if (network) {
    figures["network_expected_error_deg"] = 1e-6 * kDegrees * report.predicted_error_urad;
    if (truth != nullptr) figures["network_error_deg"] = angle_deg(network->q_lrf_trf, truth->q_lrf_trf);
  }
  if (registered) {
    const Eigen::Vector3d sigma_urad(report.pose_sigma[0], report.pose_sigma[1], report.pose_sigma[2]);
    const auto& rate = report.pose_rate_lrf_urad_s;
    figures["pose_sigma_deg"] = 1e-6 * kDegrees * sigma_urad.norm();
    figures["pose_range_m"] = registered->origin_lrf_m.y();
    figures["pose_rate_deg_s"] = 1e-6 * kDegrees * Eigen::Vector3d(rate[0], rate[1], rate[2]).norm();
    if (truth != nullptr) figures["pose_error_deg"] = angle_deg(registered->q_lrf_trf, truth->q_lrf_trf);
  }
  if (truth == nullptr) return figures.dump();
  if (is_known(truth->range_m)) figures["true_range_m"] = truth->range_m;
  if (is_known(truth->rate_lrf_rad_s.x()))
    figures["true_rate_deg_s"] = kDegrees * truth->rate_lrf_rad_s.norm();
  return figures.dump();
}

}  // namespace tumblesight::sim
