// WebSocketOutlet: the messages to one client with a WebSocket (RFC 6455). A message goes out whole, however
// long the client stands still in it, for instance in a debugger. One that has taken nothing for too long
// loses its connection, so that it does not take the place of another one for ever.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string_view>

struct mg_connection;

namespace tumblesight::sim {

class WebSocketOutlet {
 public:
  // `patience`: how long a client may stand still. Looked at every few seconds.
  WebSocketOutlet(mg_connection* connection, std::chrono::milliseconds patience)
      : connection_(connection), patience_(patience) {}

  // For any thread. Waits for the client. False: the message did not go out whole, and the connection ends.
  bool send(int opcode, std::string_view bytes);
  // The connection ends: nobody waits for the client any more.
  void abandon() { is_abandoned_ = true; }

 private:
  bool write(std::string_view bytes);

  mg_connection* connection_;
  std::chrono::milliseconds patience_;
  std::atomic<bool> is_abandoned_{false};
  std::mutex mutex_;  // a message at a time
  bool has_failed_ = false;
};

}  // namespace tumblesight::sim
