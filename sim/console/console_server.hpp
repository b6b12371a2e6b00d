// ConsoleServer: answers the page of the console over HTTP on loopback, and tells it over a WebSocket when
// there is something new. Foxglove and Lichtblick attach to the same port by their own protocol. Each client
// has a thread of its own: a slow one delays nobody else.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "sim/console/requests.hpp"

struct mg_context;
struct mg_connection;

namespace tumblesight::sim {

class ConsoleServer {
 public:
  static constexpr int kMostClients = 16;  // with a WebSocket; another one is refused

  static constexpr std::chrono::seconds kPatience{30};

  // Port 0: a free one. Throws std::runtime_error: the port is taken, or a library of the page is missing.
  // `requests` must outlive the object. `patience`: how long a client with a WebSocket may stand still until
  // it loses its connection.
  ConsoleServer(const Requests& requests, int port, std::chrono::milliseconds patience = kPatience);
  ~ConsoleServer();
  ConsoleServer(const ConsoleServer&) = delete;
  ConsoleServer& operator=(const ConsoleServer&) = delete;

  int port() const { return port_; }
  int clients() const;

 private:
  class Client;
  class PageClient;
  class FoxgloveClient;
  struct Handlers;

  const Requests& requests_;
  std::chrono::milliseconds patience_;
  int port_ = 0;
  mutable std::mutex mutex_;  // of clients_
  std::map<const mg_connection*, std::unique_ptr<Client>> clients_;
  mg_context* server_ = nullptr;
};

}  // namespace tumblesight::sim
