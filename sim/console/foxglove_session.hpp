// FoxgloveSession: one client of the Foxglove WebSocket protocol, as Foxglove and Lichtblick are, without the
// network. Its channels are those of a recording, so that one layout serves both.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/console/run_source.hpp"

namespace tumblesight::sim {

class FoxgloveSession {
 public:
  static constexpr std::size_t kMostBytes = 65'536;      // of a message of the client
  static constexpr std::size_t kMostDepth = 16;          // of lists and objects in it
  static constexpr std::size_t kMostSubscriptions = 64;  // in one message; the client has one per channel
  static constexpr std::uint64_t kStepsPerPoll = 64;     // what a slow client has missed comes in parts

  struct Outgoing {
    bool is_binary;
    std::string bytes;
  };

  // `run` must outlive the object. Calls must not overlap.
  explicit FoxgloveSession(const RunSource& run) : run_(run) {}

  // What a client is told first.
  std::vector<Outgoing> begin();
  // The answer to a message of the client: a warning, or nothing.
  std::vector<Outgoing> receive(std::string_view text);
  // What is new since the last call. A channel begins with the newest step. Point clouds are large: a client
  // that has missed some gets the newest one alone.
  std::vector<Outgoing> poll();

 private:
  struct Subscription {
    std::uint32_t channel;
    std::uint64_t next;  // step to send
  };

  // Empty, or why it is refused.
  std::string subscribe(const nlohmann::json& message);
  std::string add_subscription(const nlohmann::json& wanted);
  std::string unsubscribe(const nlohmann::json& message);
  void add_step(std::uint64_t number, bool is_newest, std::vector<Outgoing>& out);
  // True: the client has all that there is of this step.
  bool add_points(std::uint64_t number, std::int64_t time_ns, std::uint32_t id, std::vector<Outgoing>& out);
  void add_message(const LoggedStep& step, std::uint64_t number, std::uint32_t id, std::uint32_t channel,
                   std::vector<Outgoing>& out);
  std::int64_t shown_time_ns(std::int64_t time_ns) const;

  const RunSource& run_;
  std::uint32_t run_id_ = 0;
  std::optional<std::int64_t> first_ns_;  // of the first step of the run, or of the first that is sent
  std::map<std::uint32_t, Subscription> subscriptions_;
};

}  // namespace tumblesight::sim
