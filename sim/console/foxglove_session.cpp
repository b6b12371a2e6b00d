#include "sim/console/foxglove_session.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sim/console/little_endian.hpp"
#include "sim/json/json_text.hpp"

namespace tumblesight::sim {
namespace {

using Outgoing = FoxgloveSession::Outgoing;
using Message = nlohmann::json;

constexpr int kWarning = 1, kError = 2;
constexpr char kMessageData = 1;

// Of a channel: from 1 on.
std::uint32_t channel_of(View view) {
  return 1 + static_cast<std::uint32_t>(view);
}
std::optional<View> view_of(std::uint32_t channel) {
  if (channel < 1 || channel > kViews.size()) return std::nullopt;
  return kViews.at(channel - 1);
}

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
  for (const View view : kViews) {
    const ShownChannel& channel = shown_channel(view);
    channels.push_back({{"id", channel_of(view)},
                        {"topic", channel.topic},
                        {"encoding", "json"},
                        {"schemaName", channel.schema_name},
                        {"schema", channel.schema},
                        {"schemaEncoding", "jsonschema"}});
  }
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

}  // namespace

std::vector<Outgoing> FoxgloveSession::begin() {
  shown_.begin();
  return greeting();
}

std::vector<Outgoing> FoxgloveSession::greeting() {
  told_run_id_ = shown_.run_id();
  return {server_info(told_run_id_), advertisement()};
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
  const std::optional<View> view = view_of(*channel);
  if (!view) return "there is no channel " + std::to_string(*channel);
  if (shown_.find(*id) != nullptr) return "there is already a subscription " + std::to_string(*id);
  if (const std::uint32_t* const other = shown_.find(*view))
    return "channel " + std::to_string(*channel) + " has already subscription " + std::to_string(*other);
  shown_.follow(*id, *view);
  return {};
}

std::string FoxgloveSession::unsubscribe(const Message& message) {
  const Message* const list = list_of(message, "subscriptionIds");
  if (list == nullptr) return "unsubscribe needs subscriptionIds, a list of at most 64";
  std::string problem;
  for (const Message& wanted : *list) {
    const std::optional<std::uint32_t> id = id_of(wanted);
    if (!id || !shown_.forget(*id)) problem = "there is no subscription of this id";
  }
  return problem;
}

std::vector<Outgoing> FoxgloveSession::poll() {
  const std::vector<ShownRun::Message> news = shown_.poll();
  std::vector<Outgoing> out;
  // A client forgets the types of the session before, so that it needs the channels again. Its subscriptions
  // stay.
  if (shown_.run_id() != told_run_id_) out = greeting();
  for (const ShownRun::Message& message : news)
    out.push_back(message.is_failure ? status(kError, message.text)
                                     : data_of(message.id, message.time_ns, message.text));
  return out;
}

}  // namespace tumblesight::sim
