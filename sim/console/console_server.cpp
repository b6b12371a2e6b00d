#include "sim/console/console_server.hpp"

#include <civetweb.h>
#include <strings.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/console/foxglove_session.hpp"
#include "sim/console/page_files.hpp"
#include "sim/console/websocket_outlet.hpp"

namespace tumblesight::sim {
namespace {

using namespace std::chrono_literals;

constexpr auto kBetweenNews = 50ms;
// Threads of the server. Each open connection takes one, also one whose request never comes or whose answer
// is not read, for some seconds. A connection has one request, so that it cannot hold its thread longer. A
// thread that waits costs some 30 KB. Beyond so many connections at a time others wait for a time-out or
// more.
constexpr const char* kThreads = "512";
constexpr const char* kWaiting = "200";
// Until the head of a request is there, and while nothing can be written.
constexpr const char* kRequestTimeout_ms = "3000";
constexpr auto kBodyTimeout = 2s;
// Of a whole answer: so long, and longer the larger it is. What fits into the buffers of the connection, some
// 3 MB, is not waited for.
constexpr auto kAnswerTimeout = 3s;
constexpr int kSlowestReader_bytes_per_s = 128 * 1024;

// How often it is seen that nothing more can be sent to a client with a WebSocket.
constexpr const char* kLookAtClient_ms = "1000";

std::string text_or_empty(const char* text) {
  return text == nullptr ? std::string() : std::string(text);
}

Request request_of(const mg_connection* connection) {
  const mg_request_info* const info = mg_get_request_info(connection);
  return {text_or_empty(info->request_method),
          text_or_empty(info->local_uri),
          text_or_empty(info->query_string),
          text_or_empty(mg_get_header(connection, "Host")),
          text_or_empty(mg_get_header(connection, "Origin")),
          {}};
}

// Empty if the body of a request has one length that all programs on its way agree upon.
std::string fault_of_length(const mg_connection* connection) {
  const mg_request_info* const info = mg_get_request_info(connection);
  const std::string remedy = "; send one Content-Length, in digits";
  // Of more civetweb keeps the first ones.
  if (info->num_headers >= static_cast<int>(std::size(info->http_headers)))
    return "the request has too many header fields";
  int lengths = 0;
  for (int i = 0; i < info->num_headers; ++i) {
    const mg_header& header = info->http_headers[i];
    if (strcasecmp(header.name, "Transfer-Encoding") == 0) return "a body in chunks is not taken" + remedy;
    if (strcasecmp(header.name, "Content-Length") != 0) continue;
    const std::string_view digits = header.value;
    if (digits.empty() || digits.find_first_not_of("0123456789") != std::string_view::npos)
      return "the Content-Length is no number" + remedy;
    ++lengths;
  }
  if (lengths == 1 && info->content_length >= 0) return {};
  return (lengths > 1 ? "more than one Content-Length" : "no Content-Length") + remedy;
}

// At most a byte more than any request has. One that comes byte by byte is cut after a while: civetweb has no
// limit for the time of a whole body, so that it is asked for single bytes.
std::string body_of(mg_connection* connection) {
  const auto end = std::chrono::steady_clock::now() + kBodyTimeout;
  std::string body;
  char byte = 0;
  while (body.size() <= Requests::kMostBody && std::chrono::steady_clock::now() < end &&
         mg_read(connection, &byte, 1) == 1)
    body += byte;
  return body;
}

// In parts, since civetweb waits anew for every byte that is taken. False: it did not go out whole.
bool send_in_time(mg_connection* connection, std::string_view bytes) {
  constexpr std::size_t kPart = 4096;
  const std::chrono::seconds for_size(static_cast<int>(bytes.size()) / kSlowestReader_bytes_per_s);
  const auto end = std::chrono::steady_clock::now() + kAnswerTimeout + for_size;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(kPart, bytes.size()))) {
    const std::size_t part = std::min(kPart, bytes.size());
    if (std::chrono::steady_clock::now() > end ||
        mg_write(connection, bytes.data(), part) != static_cast<int>(part))
      return false;
  }
  return true;
}

void send_answer(mg_connection* connection, const Answer& answer, bool with_body) {
  std::string whole = "HTTP/1.1 " + std::to_string(answer.status) + " " +
                      mg_get_response_code_text(connection, answer.status) +
                      "\r\nContent-Type: " + answer.type +
                      "\r\nContent-Length: " + std::to_string(answer.body.size()) +
                      (answer.allow.empty() ? "" : "\r\nAllow: " + answer.allow) +
                      "\r\nConnection: close\r\nCache-Control: no-store\r\nX-Content-Type-Options: "
                      "nosniff\r\nReferrer-Policy: no-referrer"
                      "\r\nContent-Security-Policy: default-src 'self'; style-src 'self' 'unsafe-inline'; "
                      "img-src 'self' data: blob:; connect-src 'self' ws:; frame-ancestors 'none'\r\n\r\n";
  if (with_body) whole += answer.body;
  send_in_time(connection, whole);
}

Answer plain(int status, std::string text) {
  return {status, "text/plain; charset=utf-8", std::move(text), ""};
}

// Repeats something in a thread of its own, until it returns false or the object ends.
class Repeating {
 public:
  ~Repeating() {
    is_leaving_ = true;
    if (thread_.joinable()) thread_.join();
  }
  void start(std::function<bool()> what) {
    thread_ = std::thread([this, what = std::move(what)] {
      while (!is_leaving_ && what()) std::this_thread::sleep_for(kBetweenNews);
    });
  }

 private:
  std::atomic<bool> is_leaving_{false};
  std::thread thread_;
};

}  // namespace

class ConsoleServer::Client {
 public:
  virtual ~Client() = default;
  // A part of a message of the client, with the first byte of its frame (RFC 6455). False: the connection
  // ends.
  virtual bool receive(int first_byte, std::string_view bytes) = 0;
};

// Gets the state whenever it has changed. A page only listens.
class ConsoleServer::PageClient final : public Client {
 public:
  PageClient(mg_connection* connection, const Requests& requests, std::chrono::milliseconds patience)
      : outlet_(connection, patience) {
    repeating_.start([this, &requests, last = std::string()]() mutable {
      std::string now = requests.state_text();
      if (now != last && !outlet_.send(MG_WEBSOCKET_OPCODE_TEXT, now)) return false;
      last = std::move(now);
      return true;
    });
  }
  ~PageClient() override { outlet_.abandon(); }
  bool receive(int, std::string_view) override { return true; }

 private:
  WebSocketOutlet outlet_;
  Repeating repeating_;  // last: ends before what it uses
};

class ConsoleServer::FoxgloveClient final : public Client {
 public:
  FoxgloveClient(mg_connection* connection, const RunSource& run, std::chrono::milliseconds patience)
      : outlet_(connection, patience), session_(run) {
    send(session_.begin());
    repeating_.start([this] { return send_news(); });
  }
  ~FoxgloveClient() override { outlet_.abandon(); }
  bool receive(int first_byte, std::string_view bytes) override {
    constexpr int kOpcode = 0x0F, kIsLast = 0x80;
    if (message_.size() + bytes.size() > FoxgloveSession::kMostBytes) return false;
    switch (first_byte & kOpcode) {
      case MG_WEBSOCKET_OPCODE_CONNECTION_CLOSE:
        outlet_.send(MG_WEBSOCKET_OPCODE_CONNECTION_CLOSE, bytes);
        return false;
      case MG_WEBSOCKET_OPCODE_PING:
        return outlet_.send(MG_WEBSOCKET_OPCODE_PONG, bytes);
      case MG_WEBSOCKET_OPCODE_PONG:
        return true;
      default:
        message_ += bytes;
        return (first_byte & kIsLast) == 0 || answer();
    }
  }

 private:
  bool answer() {
    std::vector<FoxgloveSession::Outgoing> answers;
    {
      const std::lock_guard lock(mutex_);
      answers = session_.receive(message_);
    }
    message_.clear();
    return send(answers);
  }
  // The next news are asked for when these have gone out, so that a client that stood still gets the newest
  // points, and all of the rest.
  bool send_news() {
    std::vector<FoxgloveSession::Outgoing> news;
    {
      const std::lock_guard lock(mutex_);
      news = session_.poll();
    }
    return send(news);
  }
  // Without the lock: a client that does not read makes it wait.
  bool send(const std::vector<FoxgloveSession::Outgoing>& messages) {
    return std::all_of(messages.begin(), messages.end(), [this](const FoxgloveSession::Outgoing& message) {
      return outlet_.send(message.is_binary ? MG_WEBSOCKET_OPCODE_BINARY : MG_WEBSOCKET_OPCODE_TEXT,
                          message.bytes);
    });
  }

  WebSocketOutlet outlet_;
  std::mutex mutex_;  // of the session
  FoxgloveSession session_;
  std::string message_;  // of which not all has come
  Repeating repeating_;  // last: ends before what it uses
};

struct ConsoleServer::Handlers {
  static ConsoleServer& server(void* self) { return *static_cast<ConsoleServer*>(self); }

  static int request(mg_connection* connection, void* self) {
    Request request = request_of(connection);
    const ConsoleServer& own = server(self);
    // Nobody is waited for who gets no answer.
    const bool has_body = own.requests_.takes_body_of(request, own.port_);
    std::string fault = has_body ? fault_of_length(connection) : "";
    if (has_body && fault.empty()) {
      request.body = body_of(connection);
      const long long length = mg_get_request_info(connection)->content_length;
      if (static_cast<long long>(request.body.size()) < std::min<long long>(length, Requests::kMostBody + 1))
        fault = "the body ended before its Content-Length; send all of it";
    }
    const Answer answer = fault.empty() ? own.requests_.answer(request, own.port_) : plain(400, fault);
    send_answer(connection, answer, request.method != "HEAD");
    // Or civetweb would wait for the rest of a body that was not read.
    mg_disable_connection_keep_alive(connection);
    return answer.status;
  }
  // Civetweb sets it only if the client names one, and a thread uses the same object for all its connections:
  // a page would get the subprotocol of a client before, and a browser refuses that.
  static void forget_subprotocol(const mg_connection* connection) {
    const_cast<mg_request_info*>(mg_get_request_info(connection))->acceptedWebSocketSubprotocol = nullptr;
  }
  // Civetweb closes such a connection without an answer. 0: the handlers answer; else the status.
  static int refuse_upgrade(mg_connection* connection) {
    if (strcasecmp(text_or_empty(mg_get_header(connection, "Upgrade")).c_str(), "websocket") != 0) return 0;
    Answer refusal;
    if (text_or_empty(mg_get_header(connection, "Sec-WebSocket-Version")) != "13")
      refusal = plain(426, "this console takes WebSocket version 13 (RFC 6455)");
    else if (text_or_empty(mg_get_header(connection, "Sec-WebSocket-Key")).empty())
      refusal = plain(400, "a WebSocket needs a Sec-WebSocket-Key (RFC 6455)");
    else
      return 0;
    send_answer(connection, refusal, true);
    mg_disable_connection_keep_alive(connection);
    return refusal.status;
  }
  // Not 0: the connection is refused.
  static int connect_page(const mg_connection* connection, void* self) {
    ConsoleServer& own = server(self);
    forget_subprotocol(connection);  // civetweb would take any
    return end_of(own, connection, plain(403, own.requests_.refusal_of(request_of(connection), own.port_)));
  }
  static int connect_foxglove(const mg_connection* connection, void* self) {
    ConsoleServer& own = server(self);
    Answer refusal = plain(403, own.requests_.refusal_of_foxglove(request_of(connection), own.port_));
    if (refusal.body.empty() && mg_get_request_info(connection)->acceptedWebSocketSubprotocol == nullptr) {
      refusal.status = 400;
      refusal.body = "the subprotocol here is foxglove.sdk.v1 or foxglove.websocket.v1";
    }
    return end_of(own, connection, std::move(refusal));
  }
  // `refusal`: empty without a reason.
  static int end_of(const ConsoleServer& own, const mg_connection* connection, Answer refusal) {
    if (refusal.body.empty() && own.clients() >= kMostClients)
      refusal = plain(503, "this console has as many clients as it takes");
    if (refusal.body.empty()) return 0;
    // Civetweb itself gives no reason. Nothing else uses the connection now.
    auto* const answered = const_cast<mg_connection*>(connection);
    send_answer(answered, refusal, true);
    mg_disable_connection_keep_alive(answered);
    return 1;
  }
  static void ready_page(mg_connection* connection, void* self) {
    ConsoleServer& own = server(self);
    add(connection, self, std::make_unique<PageClient>(connection, own.requests_, own.patience_));
  }
  static void ready_foxglove(mg_connection* connection, void* self) {
    ConsoleServer& own = server(self);
    add(connection, self, std::make_unique<FoxgloveClient>(connection, own.requests_.run(), own.patience_));
  }
  static void add(const mg_connection* connection, void* self, std::unique_ptr<Client> client) {
    const std::lock_guard lock(server(self).mutex_);
    server(self).clients_[connection] = std::move(client);
  }
  // 0 ends the connection. The client stays until `close`, which the same thread calls.
  static int data(mg_connection* connection, int first_byte, char* bytes, std::size_t size, void* self) {
    ConsoleServer& own = server(self);
    Client* client = nullptr;
    {
      const std::lock_guard lock(own.mutex_);
      const auto found = own.clients_.find(connection);
      if (found != own.clients_.end()) client = found->second.get();
    }
    return client != nullptr && client->receive(first_byte, {bytes, size}) ? 1 : 0;
  }
  static void close(const mg_connection* connection, void* self) {
    ConsoleServer& own = server(self);
    std::unique_ptr<Client> leaving;  // joined without the lock
    const std::lock_guard lock(own.mutex_);
    const auto found = own.clients_.find(connection);
    if (found == own.clients_.end()) return;
    leaving = std::move(found->second);
    own.clients_.erase(found);
  }
  static void listen(mg_context* context, ConsoleServer* self) {
    static const char* names[] = {"foxglove.sdk.v1", "foxglove.websocket.v1"};
    static mg_websocket_subprotocols foxglove{2, names};
    mg_set_websocket_handler(context, "/ws$", connect_page, ready_page, data, close, self);
    for (const char* path : {"/$", "/ws/foxglove$"})
      mg_set_websocket_handler_with_subprotocols(context, path, &foxglove, connect_foxglove, ready_foxglove,
                                                 data, close, self);
    mg_set_request_handler(context, "/", request, self);
  }
};

ConsoleServer::ConsoleServer(const Requests& requests, int port, std::chrono::milliseconds patience)
    : requests_(requests), patience_(patience) {
  const std::string missing = missing_libraries();
  if (!missing.empty()) throw std::runtime_error("the console cannot show its page: " + missing);
  mg_init_library(0);
  const std::string address = "127.0.0.1:" + std::to_string(port);
  const std::array<const char*, 13> options{"listening_ports",
                                            address.c_str(),
                                            "num_threads",
                                            kThreads,
                                            "listen_backlog",
                                            kWaiting,
                                            "request_timeout_ms",
                                            kRequestTimeout_ms,
                                            "enable_keep_alive",
                                            "no",
                                            "websocket_timeout_ms",
                                            kLookAtClient_ms,
                                            nullptr};
  mg_callbacks callbacks;
  std::memset(&callbacks, 0, sizeof callbacks);
  callbacks.log_message = [](const mg_connection*, const char*) { return 1; };  // no log on the terminal
  callbacks.begin_request = [](mg_connection* connection) {
    Handlers::forget_subprotocol(connection);
    return Handlers::refuse_upgrade(connection);
  };
  server_ = mg_start(&callbacks, this, const_cast<const char**>(options.data()));
  if (server_ == nullptr)
    throw std::runtime_error(
        "port " + std::to_string(port) +
        " of 127.0.0.1 cannot be used: another program has it; give another one with --port, "
        "or --port 0 for a free one");
  mg_server_port opened{};
  mg_get_server_ports(server_, 1, &opened);
  port_ = opened.port;
  Handlers::listen(server_, this);
}

ConsoleServer::~ConsoleServer() {
  mg_stop(server_);
  mg_exit_library();
}

int ConsoleServer::clients() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(clients_.size());
}

}  // namespace tumblesight::sim
