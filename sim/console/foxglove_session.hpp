// FoxgloveSession: one client of the Foxglove WebSocket protocol, as Foxglove and Lichtblick are, without the
// network. Its channels are those of a recording, so that one layout serves both.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "sim/console/shown_run.hpp"

namespace tumblesight::sim {

class FoxgloveSession {
 public:
  static constexpr std::size_t kMostBytes = 65'536;      // of a message of the client
  static constexpr std::size_t kMostDepth = 16;          // of lists and objects in it
  static constexpr std::size_t kMostSubscriptions = 64;  // in one message; the client has one per channel
  static constexpr std::uint64_t kStepsPerPoll = ShownRun::kStepsPerPoll;

  struct Outgoing {
    bool is_binary;
    std::string bytes;
  };

  // `run` must outlive the object. Calls must not overlap.
  explicit FoxgloveSession(const RunSource& run) : shown_(run) {}

  // What a client is told first.
  std::vector<Outgoing> begin();
  // The answer to a message of the client: a warning, or nothing.
  std::vector<Outgoing> receive(std::string_view text);
  // What is new since the last call (ShownRun).
  std::vector<Outgoing> poll();

 private:
  std::vector<Outgoing> greeting();
  // Empty, or why it is refused.
  std::string subscribe(const nlohmann::json& message);
  std::string add_subscription(const nlohmann::json& wanted);
  std::string unsubscribe(const nlohmann::json& message);

  ShownRun shown_;
  std::uint32_t told_run_id_ = 0;  // in the greeting
};

}  // namespace tumblesight::sim
