#include "sim/console/step_json.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "hal/messages/command_packet.hpp"
#include "hal/messages/message_fields.hpp"
#include "sim/operations/fault_names.hpp"
#include "sim/operations/function_names.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

template <class Q30>
Eigen::Quaterniond quaternion_of(const Q30& q) {
  constexpr double kOneQ30 = 1 << 30;
  return Eigen::Quaterniond(q[0] / kOneQ30, q[1] / kOneQ30, q[2] / kOneQ30, q[3] / kOneQ30).normalized();
}
Eigen::Quaterniond true_attitude(const hal::dds::TruthSample& truth) {
  const float* const q = truth.q_lrf_trf;
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}
template <class Three>
Eigen::Vector3d vector_of(const Three& three, double unit) {
  return unit * Eigen::Vector3d(three[0], three[1], three[2]);
}

Json json_of(const Eigen::Quaterniond& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}
Json json_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

bool has_attitude(const hal::AttitudeReport& report) {
  return report.validity == hal::Validity::kValid || report.validity == hal::Validity::kDoubtful;
}
bool has_pose(const hal::AttitudeReport& report) {
  return has_attitude(report) && (report.pose_doubts & hal::kPoseDoubtUnknown) == 0;
}
double sigma_deg(const hal::AttitudeReport& report) {
  return 1e-6 * kDegrees *
         Eigen::Vector3d(report.pose_sigma[0], report.pose_sigma[1], report.pose_sigma[2]).norm();
}

// What is not known stays null.
struct Figures {
  Json network_error_deg, pose_error_deg, true_range_m, true_rate_deg_s, sequence, frame;
};
Figures figures_of_truth(const LoggedStep& step) {
  Figures figures;
  if (!step.truth) return figures;
  const hal::dds::TruthSample& truth = *step.truth;
  figures.true_range_m = truth.range_m;
  figures.true_rate_deg_s = kDegrees * vector_of(truth.rate_lrf_rad_s, 1.0).norm();
  figures.sequence = truth.sequence_index;
  figures.frame = truth.frame_index;
  if (!step.truth_of_attitude) return figures;
  const Eigen::Quaterniond q = true_attitude(*step.truth_of_attitude);
  figures.network_error_deg = kDegrees * q.angularDistance(quaternion_of(step.attitude->q_lrf_trf));
  if (has_pose(*step.attitude))
    figures.pose_error_deg = kDegrees * q.angularDistance(quaternion_of(step.attitude->pose_q_lrf_trf));
  return figures;
}

// A name for each bit.
std::vector<std::string> names_of_bits(unsigned bits,
                                       const std::vector<std::pair<unsigned, const char*>>& names) {
  std::vector<std::string> found;
  for (const auto& [bit, name] : names)
    if ((bits & bit) != 0) found.push_back(name);
  return found;
}
std::vector<std::string> doubts_of_attitude(unsigned doubts) {
  return names_of_bits(doubts, {{hal::kDoubtErrorLarge, "expected error is large"},
                                {hal::kDoubtAttitudeJump, "attitude jumps"},
                                {hal::kDoubtRateAmbiguous, "rate is ambiguous"},
                                {hal::kDoubtChaserUnknown, "chaser's attitude is not known"},
                                {hal::kDoubtChaserNowUnknown, "chaser's attitude is not known now"},
                                {hal::kDoubtUnexplained, "the target does not explain the frame"}});
}
std::vector<std::string> doubts_of_pose(unsigned doubts) {
  return names_of_bits(doubts, {{hal::kPoseDoubtUnknown, "there is no pose"},
                                {hal::kPoseDoubtCoasts, "predicted, not registered"},
                                {hal::kPoseDoubtRanges, "ranges beside the surface"},
                                {hal::kPoseDoubtOutline, "outline does not fit"},
                                {hal::kPoseDoubtAmbiguous, "other attitudes are not ruled out"},
                                {hal::kPoseDoubtMotion, "no motion fits yet"},
                                {hal::kPoseDoubtUncertain, "standard deviation above 1°"},
                                {hal::kPoseDoubtNetwork, "the network disagrees"}});
}

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : ", ") + text;
  return all;
}

const char* text_of(hal::Mode mode) {
  constexpr std::array<const char*, 4> kNames{"BOOT", "STANDBY", "RUN", "SAFE"};
  const auto index = static_cast<std::size_t>(mode);
  return index < kNames.size() ? kNames[index] : "unknown";
}
const char* text_of(hal::Validity validity) {
  constexpr std::array<const char*, 6> kNames{"valid",         "standby",  "no frame",
                                              "frame refused", "doubtful", "passed over"};
  const auto index = static_cast<std::size_t>(validity);
  return index < kNames.size() ? kNames[index] : "unknown";
}
const char* text_of(hal::BankStatus status) {
  constexpr std::array<const char*, 3> kNames{"empty", "loading", "good"};
  const auto index = static_cast<std::size_t>(status);
  return index < kNames.size() ? kNames[index] : "unknown";
}

Json light(const std::string& name, const std::string& text, const char* state) {
  return {{"name", name}, {"text", text}, {"state", state}};
}

Json lights_of_attitude(const hal::AttitudeReport& report) {
  const bool is_valid = report.validity == hal::Validity::kValid;
  const bool is_doubtful = report.validity == hal::Validity::kDoubtful;
  const std::string doubts = joined(doubts_of_attitude(report.doubts));
  std::string text = text_of(report.validity);
  if (!doubts.empty()) text += ": " + doubts;
  const bool is_verified = has_attitude(report) && report.pose_doubts == 0;
  const std::string pose = is_verified ? "verified" : joined(doubts_of_pose(report.pose_doubts));
  return {light("attitude", text,
                is_valid      ? "ok"
                : is_doubtful ? "warn"
                              : "off"),
          light("pose", pose,
                is_verified        ? "ok"
                : has_pose(report) ? "warn"
                                   : "off")};
}

void add_lights(const hal::Telemetry& telemetry, Json& lights) {
  const char* const state = telemetry.mode == hal::Mode::kRun    ? "ok"
                            : telemetry.mode == hal::Mode::kSafe ? "alarm"
                                                                 : "warn";
  lights.push_back(light("mode", text_of(telemetry.mode), state));
  std::vector<std::string> faults;
  for (int i = 0; i < hal::kFaults; ++i)
    if (((telemetry.faults_persisting >> i) & 1U) != 0) faults.push_back(name_of(static_cast<hal::Fault>(i)));
  lights.push_back(
      light("faults", faults.empty() ? "none" : joined(faults), faults.empty() ? "ok" : "alarm"));
  for (std::size_t i = 0; i < hal::Telemetry::kBanks; ++i) {
    const bool is_in_use = telemetry.bank_in_use == i;
    lights.push_back(light("bank " + std::to_string(i),
                           std::string(text_of(telemetry.bank_status[i])) + (is_in_use ? ", in use" : ""),
                           telemetry.bank_status[i] == hal::BankStatus::kGood ? "ok"
                           : is_in_use                                        ? "alarm"
                                                                              : "off"));
  }
  const bool is_late = telemetry.deadline_overruns != 0 || telemetry.cycle_slips != 0 ||
                       telemetry.registrations_cut_short != 0;
  lights.push_back(light("timing",
                         is_late ? std::to_string(telemetry.deadline_overruns) + " overruns, " +
                                       std::to_string(telemetry.cycle_slips) + " slips, " +
                                       std::to_string(telemetry.registrations_cut_short) + " cut short"
                                 : "no overrun",
                         is_late ? "warn" : "ok"));
  lights.push_back(light("heap", std::to_string(telemetry.heap_allocations) + " allocations",
                         telemetry.heap_allocations == 0 ? "ok" : "alarm"));
}

// Numbers, enumerators and arrays of these.
template <class Value>
Json json_of_field(const Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    return static_cast<int>(value);
  } else if constexpr (std::is_arithmetic_v<Value>) {
    return value;
  } else {
    Json array = Json::array();
    for (const auto& element : value) array.push_back(json_of_field(element));
    return array;
  }
}
Json fields_of(const hal::Telemetry& telemetry) {
  Json fields;
  std::size_t index = 0;
  hal::MessageFields<hal::Telemetry>::visit(
      [&](const auto& value) {
        fields[hal::MessageFields<hal::Telemetry>::kNames[index++]] = json_of_field(value);
      },
      telemetry);
  return fields;
}

Json pose_json(const hal::AttitudeReport& report) {
  const Eigen::Vector3d sigma_turn(report.pose_sigma[0], report.pose_sigma[1], report.pose_sigma[2]);
  const Eigen::Vector3d sigma_place(report.pose_sigma[6], report.pose_sigma[7], report.pose_sigma[8]);
  return {{"q", json_of(quaternion_of(report.pose_q_lrf_trf))},
          {"origin_m", json_of(vector_of(report.pose_origin_lrf_um, 1e-6))},
          {"sigma_deg", json_of(Eigen::Vector3d(1e-6 * kDegrees * sigma_turn))},
          {"sigma_m", json_of(Eigen::Vector3d(1e-6 * sigma_place))},
          {"rate_deg_s", json_of(vector_of(report.pose_rate_lrf_urad_s, 1e-6 * kDegrees))},
          {"verified", report.pose_doubts == 0},
          {"doubts", doubts_of_pose(report.pose_doubts)}};
}

void add_attitude(const hal::AttitudeReport& report, Json& detail) {
  if (!has_attitude(report)) return;
  detail["network"] = {{"q", json_of(quaternion_of(report.q_lrf_trf))},
                       {"origin_m", json_of(vector_of(report.centroid_lrf_mm, 1e-3))},
                       {"expected_error_deg", 1e-6 * kDegrees * report.predicted_error_urad},
                       {"valid", report.validity == hal::Validity::kValid},
                       {"doubts", doubts_of_attitude(report.doubts)}};
  if (report.second_odds_ppm != 0)
    detail["second"] = {{"q", json_of(quaternion_of(report.q_lrf_trf_second))},
                        {"odds", 1e-6 * report.second_odds_ppm}};
  if (has_pose(report)) detail["pose"] = pose_json(report);
}

}  // namespace

Json row_fields() {
  return {"k",
          "t_s",
          "sequence",
          "frame",
          "valid",
          "verified",
          "network_error_deg",
          "network_expected_deg",
          "pose_error_deg",
          "pose_expected_deg",
          "second_odds",
          "true_range_m",
          "pose_range_m",
          "true_rate_deg_s",
          "network_rate_deg_s",
          "pose_rate_deg_s",
          "pose_right_m",
          "pose_up_m",
          "cycle_ms",
          "inference_ms",
          "frames_used",
          "frames_refused",
          "frames_missing",
          "frames_repeated",
          "commands_accepted",
          "commands_refused",
          "events",
          "mode",
          "faults",
          "bank",
          "step"};
}

Json row_of(const LoggedStep& step, double seconds) {
  const Figures truth = figures_of_truth(step);
  Json expected, pose_expected, odds, pose_range, network_rate, pose_rate, right, up;
  Json valid = 0, verified = 0;
  if (step.attitude && has_attitude(*step.attitude)) {
    const hal::AttitudeReport& report = *step.attitude;
    valid = report.validity == hal::Validity::kValid ? 1 : 0;
    verified = report.pose_doubts == 0 ? 1 : 0;
    expected = 1e-6 * kDegrees * report.predicted_error_urad;
    odds = 1e-6 * report.second_odds_ppm;
    network_rate = vector_of(report.rate_lrf_urad_s, 1e-6 * kDegrees).norm();
    if (has_pose(report)) {
      const Eigen::Vector3d origin_m = vector_of(report.pose_origin_lrf_um, 1e-6);
      pose_expected = sigma_deg(report);
      pose_range = origin_m.y();
      pose_rate = vector_of(report.pose_rate_lrf_urad_s, 1e-6 * kDegrees).norm();
      right = origin_m.x();
      up = origin_m.z();
    }
  }
  Json row{step.k,
           seconds,
           truth.sequence,
           truth.frame,
           valid,
           verified,
           truth.network_error_deg,
           expected,
           truth.pose_error_deg,
           pose_expected,
           odds,
           truth.true_range_m,
           pose_range,
           truth.true_rate_deg_s,
           network_rate,
           pose_rate,
           right,
           up};
  if (!step.telemetry) {
    while (row.size() + 1 < row_fields().size()) row.push_back(nullptr);
    row.push_back(step.k);
    return row;
  }
  const hal::Telemetry& t = *step.telemetry;
  for (const Json& number :
       {Json(1e-3 * t.cycle_us), Json(1e-3 * t.inference_us), Json(t.frames_used), Json(t.frames_refused),
        Json(t.frames_missing), Json(t.frames_repeated), Json(t.commands_accepted), Json(t.commands_refused),
        Json(t.events), Json(static_cast<int>(t.mode)), Json(t.faults_persisting), Json(t.bank_in_use),
        Json(step.k)})
    row.push_back(number);
  return row;
}

Json detail_of(const LoggedStep& step, double seconds) {
  Json detail{{"k", step.k},      {"step", step.k},     {"t_s", seconds},    {"frames", step.frames},
              {"truth", nullptr}, {"network", nullptr}, {"second", nullptr}, {"pose", nullptr}};
  // At the time of what else is shown.
  const auto& truth = step.truth_of_attitude ? step.truth_of_attitude : step.truth;
  if (truth)
    detail["truth"] = {{"q", json_of(true_attitude(*truth))},
                       {"range_m", truth->range_m},
                       {"rate_deg_s", json_of(vector_of(truth->rate_lrf_rad_s, kDegrees))}};
  Json lights = Json::array();
  if (step.attitude) {
    add_attitude(*step.attitude, detail);
    lights = lights_of_attitude(*step.attitude);
  }
  if (step.telemetry) add_lights(*step.telemetry, lights);
  detail["lights"] = lights;
  detail["telemetry"] = step.telemetry ? fields_of(*step.telemetry) : Json(nullptr);
  return detail;
}

std::string text_of(const hal::dds::CommandSample& command) {
  if (command.size < hal::kCommandHeaderBytes) return "packet of " + std::to_string(command.size) + " bytes";
  std::string text =
      name_of(static_cast<hal::FunctionCode>(command.bytes[hal::kCommandFunctionOffset] & 0x7F));
  const int arguments = command.size - hal::kCommandHeaderBytes - hal::kCommandTrailerBytes;
  constexpr int kShown = 8;
  for (int i = 0; i < arguments && i < kShown; ++i)
    text += " " + std::to_string(command.bytes[hal::kCommandHeaderBytes + i]);
  return arguments > kShown ? text + " ... (" + std::to_string(arguments) + " bytes)" : text;
}

}  // namespace tumblesight::sim
