#include "sim/console/joined_recording.hpp"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "sim/recording/foxglove_messages.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::size_t kMostWaiting = 256;  // samples
constexpr std::size_t kTimesKept = 64;     // steps
// Opcode, subscription and time of FoxgloveSession's messages.
constexpr std::size_t kHeaderBytes = 1 + 4 + 8;

}  // namespace

JoinedRecording::JoinedRecording(const std::string& path, const RunSource& run)
    : file_(path, "tumblesight"), channels_(file_), session_(run) {
  // The file is one more client, of all channels.
  nlohmann::json subscriptions = nlohmann::json::array();
  const std::map<std::string, McapId> by_topic{{kPointCloudTopic, channels_.points},
                                               {kTransformsTopic, channels_.transforms},
                                               {kLogTopic, channels_.log},
                                               {kFiguresTopic, channels_.figures}};
  for (const FoxgloveSession::Outgoing& told : session_.begin()) {
    const nlohmann::json message = nlohmann::json::parse(told.bytes);
    if (message.at("op") != "advertise") continue;
    for (const nlohmann::json& channel : message.at("channels")) {
      const auto id = channel.at("id").get<std::uint32_t>();
      subscriptions.push_back({{"id", id}, {"channelId", id}});
      channel_of_subscription_[id] = by_topic.at(channel.at("topic").get<std::string>());
    }
  }
  session_.receive(nlohmann::json{{"op", "subscribe"}, {"subscriptions", subscriptions}}.dump());
}

std::int64_t JoinedRecording::time_in_file_ns(std::int64_t time_ns) {
  if (!first_ns_) first_ns_ = time_ns;
  return std::max<std::int64_t>(0, time_ns - std::min<std::int64_t>(0, *first_ns_));
}

void JoinedRecording::add_step(std::uint32_t k, std::int64_t time_ns) {
  last_ns_ = time_in_file_ns(time_ns);
  time_of_step_[k] = last_ns_;
  while (time_of_step_.size() > kTimesKept) time_of_step_.erase(time_of_step_.begin());
  write_waiting(kMostWaiting);
}

void JoinedRecording::add(const hal::dds::Topic& topic, const std::vector<std::uint8_t>& bytes,
                          std::optional<std::uint32_t> k) {
  const McapId channel = channels_.of_bus.at(&topic);
  if (!k) return file_.write(channel, last_ns_, bytes.data(), bytes.size());
  waiting_.push_back({channel, *k, bytes});
  write_waiting(kMostWaiting);
}

// Those whose step has a time, and the oldest if there are more than `most`.
void JoinedRecording::write_waiting(std::size_t most) {
  const std::size_t excess = waiting_.size() > most ? waiting_.size() - most : 0;
  std::vector<Waiting> left;
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    const auto time = time_of_step_.find(waiting_[i].k);
    if (time == time_of_step_.end() && i >= excess) {
      left.push_back(std::move(waiting_[i]));
      continue;
    }
    const std::int64_t time_ns = time == time_of_step_.end() ? last_ns_ : time->second;
    file_.write(waiting_[i].channel, time_ns, waiting_[i].bytes.data(), waiting_[i].bytes.size());
  }
  waiting_ = std::move(left);
}

void JoinedRecording::poll() {
  for (const FoxgloveSession::Outgoing& message : session_.poll()) {
    if (!message.is_binary || message.bytes.size() < kHeaderBytes) continue;
    std::uint32_t subscription = 0;
    std::uint64_t time_ns = 0;
    std::memcpy(&subscription, message.bytes.data() + 1, sizeof subscription);
    std::memcpy(&time_ns, message.bytes.data() + 1 + sizeof subscription, sizeof time_ns);
    file_.write(channel_of_subscription_.at(subscription), static_cast<std::int64_t>(time_ns),
                std::string_view(message.bytes).substr(kHeaderBytes));
  }
  file_.write_due();
}

void JoinedRecording::close() {
  poll();
  write_waiting(0);
  file_.close();
}

}  // namespace tumblesight::sim
