#include "sim/console/foxglove_session.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sim/console/little_endian.hpp"
#include "sim/json/json_text.hpp"
#include "sim/recording/foxglove_messages.hpp"
#include "sim/recording/run_step.hpp"

namespace tumblesight::sim {
namespace {

using Outgoing = FoxgloveSession::Outgoing;
using Message = nlohmann::json;

constexpr std::uint32_t kPoints = 1, kTransforms = 2, kLog = 3, kFigures = 4;
constexpr int kWarning = 1, kError = 2;
constexpr char kMessageData = 1;

struct Channel {
  std::uint32_t id;
  const char* topic;
  const FoxgloveSchema& (*schema)();
};
constexpr std::array<Channel, 4> kChannels{{{kPoints, kPointCloudTopic, point_cloud_schema},
                                            {kTransforms, kTransformsTopic, transforms_schema},
                                            {kLog, kLogTopic, log_schema},
                                            {kFigures, kFiguresTopic, figures_schema}}};

Outgoing server_info(std::uint32_t run_id) {
  char session[16];
  std::snprintf(session, sizeof session, "%08x", run_id);
  return {false, Json{{"op", "serverInfo"},
                      {"name", "tumblesight console"},
                      {"capabilities", Json::array()},
                      {"sessionId", session}}
                     .dump()};
}

Outgoing advertisement() {
  Json channels = Json::array();
  for (const Channel& channel : kChannels)
    channels.push_back({{"id", channel.id},
                        {"topic", channel.topic},
                        {"encoding", "json"},
                        {"schemaName", channel.schema().name},
                        {"schema", channel.schema().text},
                        {"schemaEncoding", "jsonschema"}});
  return {false, Json{{"op", "advertise"}, {"channels", channels}}.dump()};
}

Outgoing status(int level, const std::string& what) {
  // A file name in it need not be UTF-8.
  return {false, Json{{"op", "status"}, {"level", level}, {"message", what}}.dump(
                     -1, ' ', false, Json::error_handler_t::replace)};
}

Outgoing data_of(std::uint32_t subscription, std::int64_t time_ns, const std::string& payload) {
  const auto time = static_cast<std::uint64_t>(time_ns);
  std::string bytes(1, kMessageData);
  put_u32(bytes, subscription);
  put_u32(bytes, static_cast<std::uint32_t>(time & 0xFFFFFFFF));
  put_u32(bytes, static_cast<std::uint32_t>(time >> 32));
  return {true, bytes + payload};
}

// Not one: a number that is negative, broken or too large, or none.
std::optional<std::uint32_t> id_of(const Message& value) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > UINT32_MAX) return std::nullopt;
  return value.get<std::uint32_t>();
}
std::optional<std::uint32_t> id_of(const Message& object, const char* name) {
  if (!object.is_object() || !object.contains(name)) return std::nullopt;
  return id_of(object.at(name));
}

// Null: the message has no such list, or one that is too long.
const Message* list_of(const Message& message, const char* name) {
  const auto found = message.find(name);
  const bool is_usable =
      found != message.end() && found->is_array() && found->size() <= FoxgloveSession::kMostSubscriptions;
  return is_usable ? &*found : nullptr;
}

// Where the target is off the boresight is not known here.
FrameTruth frame_truth_of(const hal::dds::TruthSample& sample) {
  FrameTruth truth{};
  const float* const q = sample.q_lrf_trf;
  const float* const rate = sample.rate_lrf_rad_s;
  truth.q_lrf_trf = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  truth.rate_lrf_rad_s = Eigen::Vector3d(rate[0], rate[1], rate[2]);
  truth.range_m = sample.range_m;
  return truth;
}

}  // namespace

std::vector<Outgoing> FoxgloveSession::begin() {
  run_id_ = run_.log().state().run_id;
  return {server_info(run_id_), advertisement()};
}

std::vector<Outgoing> FoxgloveSession::receive(std::string_view text) {
  if (text.size() > kMostBytes) return {status(kWarning, "the message has more than 64 KiB")};
  Message message;
  try {
    message = parse_json(text, {kMostDepth});
  } catch (const std::invalid_argument& refusal) {
    return {status(kWarning, std::string("the message is not taken: ") + refusal.what())};
  }
  if (!message.is_object() || !message.contains("op") || !message.at("op").is_string())
    return {status(kWarning, "the message is no JSON object with an op: this server only sends")};
  const std::string op = message.at("op").get<std::string>();
  std::string problem = "this server takes subscribe and unsubscribe, and no other op";
  if (op == "subscribe") problem = subscribe(message);
  if (op == "unsubscribe") problem = unsubscribe(message);
  if (problem.empty()) return {};
  return {status(kWarning, problem)};
}

std::string FoxgloveSession::subscribe(const Message& message) {
  const Message* const list = list_of(message, "subscriptions");
  if (list == nullptr) return "subscribe needs subscriptions, a list of at most 64";
  std::string problem;
  for (const Message& wanted : *list) {
    const std::string own = add_subscription(wanted);
    if (problem.empty()) problem = own;
  }
  return problem;
}

std::string FoxgloveSession::add_subscription(const Message& wanted) {
  const std::optional<std::uint32_t> id = id_of(wanted, "id"), channel = id_of(wanted, "channelId");
  if (!id || !channel) return "a subscription needs id and channelId, whole numbers of 32 bits";
  const auto is_channel = [channel](const auto& one) { return one.id == *channel; };
  if (std::none_of(kChannels.begin(), kChannels.end(), is_channel))
    return "there is no channel " + std::to_string(*channel);
  if (subscriptions_.count(*id) != 0) return "there is already a subscription " + std::to_string(*id);
  for (const auto& [other, subscription] : subscriptions_)
    if (subscription.channel == *channel)
      return "channel " + std::to_string(*channel) + " has already subscription " + std::to_string(other);
  const std::uint64_t steps = run_.log().state().steps;
  subscriptions_[*id] = {*channel, steps == 0 ? 0 : steps - 1};
  return {};
}

std::string FoxgloveSession::unsubscribe(const Message& message) {
  const Message* const list = list_of(message, "subscriptionIds");
  if (list == nullptr) return "unsubscribe needs subscriptionIds, a list of at most 64";
  std::string problem;
  for (const Message& wanted : *list) {
    const std::optional<std::uint32_t> id = id_of(wanted);
    if (!id || subscriptions_.erase(*id) == 0) problem = "there is no subscription of this id";
  }
  return problem;
}

std::vector<Outgoing> FoxgloveSession::poll() {
  std::vector<Outgoing> out;
  const StepLog::State state = run_.log().state();
  if (state.run_id != run_id_) {
    // A client forgets the types of the session before, so that it needs the channels again. Its
    // subscriptions stay.
    out = begin();
    first_ns_.reset();
    for (auto& [id, subscription] : subscriptions_) subscription.next = 0;
  }
  std::uint64_t first = state.steps;
  for (const auto& [id, subscription] : subscriptions_) first = std::min(first, subscription.next);
  const std::uint64_t last = std::min(state.steps, first + kStepsPerPoll);
  for (std::uint64_t number = first; number < last; ++number)
    add_step(number, number + 1 == state.steps, out);
  return out;
}

void FoxgloveSession::add_step(std::uint64_t number, bool is_newest, std::vector<Outgoing>& out) {
  const std::optional<LoggedStep> step = run_.log().logged(number);
  if (step && !first_ns_) first_ns_ = run_.log().logged(0).value_or(*step).time_ns;
  for (auto& [id, subscription] : subscriptions_) {
    if (subscription.next != number) continue;
    bool is_done = true;
    if (step && subscription.channel != kPoints) add_message(*step, number, id, subscription.channel, out);
    if (step && subscription.channel == kPoints && is_newest)
      is_done = add_points(number, shown_time_ns(step->time_ns), id, out);
    if (is_done) ++subscription.next;
  }
}

bool FoxgloveSession::add_points(std::uint64_t number, std::int64_t time_ns, std::uint32_t id,
                                 std::vector<Outgoing>& out) {
  const auto frame = std::make_unique<gnc::RangeImage>();
  try {
    // Large samples may come later than the small ones of their step. Until the next step they are waited
    // for.
    if (!run_.frame(number, *frame)) return false;
  } catch (const std::runtime_error& error) {
    out.push_back(status(kError, std::string("the frame cannot be read: ") + error.what()));
    return true;
  }
  out.push_back(data_of(id, time_ns, point_cloud_json(*frame, time_ns)));
  return true;
}

void FoxgloveSession::add_message(const LoggedStep& step, std::uint64_t number, std::uint32_t id,
                                  std::uint32_t channel, std::vector<Outgoing>& out) {
  const std::int64_t time_ns = shown_time_ns(step.time_ns);
  if (channel == kLog) {
    for (const hal::Event& event : run_.log().events_of(number))
      out.push_back(data_of(id, time_ns, log_json(event, time_ns)));
    return;
  }
  hal::AttitudeReport report;
  report.validity = hal::Validity::kNoFrame;
  if (step.attitude) report = *step.attitude;
  // At the time of the attitude, if there is one.
  const auto& sample = gives_attitude(report) ? step.truth_of_attitude : step.truth;
  const FrameTruth known = sample ? frame_truth_of(*sample) : FrameTruth{};
  const FrameTruth* const truth = sample ? &known : nullptr;
  // Where the target was when the points were measured, as in a recording.
  const std::int64_t pose_ns = gives_attitude(report) ? shown_time_ns(report.exposure_time_ns) : time_ns;
  out.push_back(data_of(
      id, time_ns,
      channel == kTransforms ? transforms_json(report, truth, 0.0, pose_ns) : figures_json(report, truth)));
}

// As in a recording: times of the protocol are not negative, those of a run may be.
std::int64_t FoxgloveSession::shown_time_ns(std::int64_t time_ns) const {
  return std::max<std::int64_t>(0, time_ns - std::min<std::int64_t>(0, first_ns_.value_or(0)));
}

}  // namespace tumblesight::sim
