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

// The frame "lrf" is the LiDAR frame: +x right, +y boresight, +z up.
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

// "lrf" to the target at its true attitude ("target_true"), and to where the flight program has it: at the
// attitude of the network ("target_network") and at the registered pose ("target_pose"), if there is one.
std::string transforms_json(const ShownStep& step, const ShownTime& time) {
  // Where the target was when the points were measured: in a free run the answer comes cycles later.
  const bool has_attitude = step.report != nullptr && gives_attitude(*step.report);
  const std::int64_t time_ns = time(has_attitude ? step.report->exposure_time_ns : step.time_ns);
  Json transforms = Json::array();
  if (step.truth != nullptr && is_known(step.truth->range_m)) {
    const Eigen::Vector2d offset_m = step.swath_m * step.truth->offset_swaths;
    const Eigen::Vector3d origin_m(offset_m.x(), step.truth->range_m, offset_m.y());
    transforms.push_back(transform("target_true", {step.truth->q_lrf_trf, origin_m}, time_ns));
  }
  if (has_attitude) {
    transforms.push_back(transform("target_network", *network_pose(*step.report), time_ns));
    if (const auto pose = registered_pose(*step.report))
      transforms.push_back(transform("target_pose", *pose, time_ns));
  }
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

// Errors in degrees, of the network and of the pose, with what the flight program expects of them; range
// along the boresight and rate; whether the attitude is valid and the pose verified. What is not known is
// left out.
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

// By View.
const std::array<ShownChannel, kViews.size()> kChannels{{
    {"/lidar/points", "foxglove.PointCloud", R"({"type":"object","properties":{
"timestamp":{"type":"object","properties":{"sec":{"type":"integer"},"nsec":{"type":"integer"}}},
"frame_id":{"type":"string"},
"pose":{"type":"object","properties":{
"position":{"type":"object","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}}},
"orientation":{"type":"object","properties":{
"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"},"w":{"type":"number"}}}}},
"point_stride":{"type":"integer"},
"fields":{"type":"array","items":{"type":"object","properties":{
"name":{"type":"string"},"offset":{"type":"integer"},"type":{"type":"integer"}}}},
"data":{"type":"string","contentEncoding":"base64"}}})"},
    {"/tf", "foxglove.FrameTransforms", R"({"type":"object","properties":{
"transforms":{"type":"array","items":{"type":"object","properties":{
"timestamp":{"type":"object","properties":{"sec":{"type":"integer"},"nsec":{"type":"integer"}}},
"parent_frame_id":{"type":"string"},"child_frame_id":{"type":"string"},
"translation":{"type":"object","properties":{
"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}}},
"rotation":{"type":"object","properties":{
"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"},"w":{"type":"number"}}}}}}}})"},
    {"/events", "foxglove.Log", R"({"type":"object","properties":{
"timestamp":{"type":"object","properties":{"sec":{"type":"integer"},"nsec":{"type":"integer"}}},
"level":{"type":"integer"},"message":{"type":"string"},"name":{"type":"string"},"file":{"type":"string"},
"line":{"type":"integer"}}})"},
    {"/figures", "tumblesight.Figures", R"({"type":"object","properties":{
"network_error_deg":{"type":"number"},"network_expected_error_deg":{"type":"number"},
"pose_error_deg":{"type":"number"},"pose_sigma_deg":{"type":"number"},
"true_range_m":{"type":"number"},"pose_range_m":{"type":"number"},
"true_rate_deg_s":{"type":"number"},"pose_rate_deg_s":{"type":"number"},
"valid":{"type":"boolean"},"verified":{"type":"boolean"}}})"},
}};

}  // namespace

const ShownChannel& shown_channel(View view) {
  return kChannels.at(static_cast<std::size_t>(view));
}

std::vector<std::string> messages_of(const ShownStep& step, const ShownTime& time, View view) {
  const std::int64_t time_ns = time(step.time_ns);
  std::vector<std::string> messages;
  switch (view) {
    case View::kPoints:
      for (const gnc::RangeImage* frame : step.frames) messages.push_back(point_cloud_json(*frame, time_ns));
      break;
    case View::kTransforms:
      if (step.report != nullptr || step.truth != nullptr) messages.push_back(transforms_json(step, time));
      break;
    case View::kLog:
      for (const hal::Event& event : step.events) messages.push_back(log_json(event, time_ns));
      break;
    case View::kFigures:
      if (step.report != nullptr) messages.push_back(figures_json(*step.report, step.truth));
      break;
  }
  return messages;
}

}  // namespace tumblesight::sim
