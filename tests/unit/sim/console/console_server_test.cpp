// What the console's server does with connections that no browser makes: it stays there for those that are.
// Verifies TS-SIL-195.
#include "sim/console/console_server.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/growing_run.hpp"

namespace tumblesight::sim {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

class RawClient {
 public:
  // `receive_buffer` in bytes; 0: as the system has it.
  explicit RawClient(int port, int receive_buffer = 0)
      : port_(port), socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval limit{10, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    if (receive_buffer > 0)
      setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  RawClient(RawClient&& other) noexcept : port_(other.port_), socket_(std::exchange(other.socket_, -1)) {}
  ~RawClient() {
    if (socket_ >= 0) close(socket_);
  }
  RawClient& send(const std::string& bytes) {
    (void)!::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    return *this;
  }
  RawClient& get(const std::string& target, const std::string& headers = "",
                 const std::string& method = "GET") {
    return send(method + " " + target + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port_) + "\r\n" +
                headers + "\r\n");
  }
  std::string read_until(const std::string& text) {
    std::string received;
    char buffer[4096];
    for (std::size_t from = 0; received.find(text, from) == std::string::npos;) {
      from = received.size() - std::min(received.size(), text.size());
      const ssize_t count = recv(socket_, buffer, sizeof buffer, 0);
      if (count <= 0) break;
      received.append(buffer, static_cast<std::size_t>(count));
    }
    return received;
  }
  std::string read_all() {
    std::string received;
    char buffer[65536];
    for (ssize_t count = 0; (count = recv(socket_, buffer, sizeof buffer, 0)) > 0;)
      received.append(buffer, static_cast<std::size_t>(count));
    return received;
  }
  std::string head() { return read_until("\r\n\r\n"); }
  // Nothing more is sent.
  RawClient& finish() {
    shutdown(socket_, SHUT_WR);
    return *this;
  }
  // Nothing of that is seen here before all has been read.
  bool is_connected_at_the_server() const {
    sockaddr_in own{};
    socklen_t size = sizeof own;
    EXPECT_EQ(getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size), 0);
    char wanted[64];  // local address, remote address, ESTABLISHED
    std::snprintf(wanted, sizeof wanted, "0100007F:%04X 0100007F:%04X 01 ", static_cast<unsigned>(port_),
                  static_cast<unsigned>(ntohs(own.sin_port)));
    std::ifstream table("/proc/net/tcp");
    return std::string(std::istreambuf_iterator<char>(table), {}).find(wanted) != std::string::npos;
  }
  bool is_closed_within(std::chrono::milliseconds time) {
    const auto end = Clock::now() + time;
    char buffer[4096];
    for (pollfd readable{socket_, POLLIN, 0}; Clock::now() < end;) {
      if (poll(&readable, 1, 50) > 0 && recv(socket_, buffer, sizeof buffer, 0) <= 0) return true;
    }
    return false;
  }

 private:
  int port_;
  int socket_;
};

class ConsoleServerOnLoopback : public testing::Test {
 protected:
  RawClient client(int receive_buffer = 0) const { return RawClient(server_.port(), receive_buffer); }
  std::string host() const { return "127.0.0.1:" + std::to_string(server_.port()); }
  std::string head_of(const std::string& target, const std::string& headers = "") const {
    return client().get(target, headers).head();
  }
  void expect_served() const {
    const auto begin = Clock::now();
    EXPECT_EQ(head_of("/?token=abc").find("HTTP/1.1 200"), 0U);
    EXPECT_LT(Clock::now() - begin, 2s);
  }
  bool wait_for_clients(int count) const {
    for (const auto end = Clock::now() + 5s; Clock::now() < end; std::this_thread::sleep_for(2ms))
      if (server_.clients() == count) return true;
    return false;
  }

  test::GrowingRun run_;
  Requests requests_{run_, [](const std::string&) { return ""; }, "abc"};
  ConsoleServer server_{requests_, 0};
};

std::string upgrade(const std::string& subprotocol = "") {
  return "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
         (subprotocol.empty() ? "" : "Sec-WebSocket-Protocol: " + subprotocol + "\r\n");
}

// A thread of the server has many connections one after another. Chromium refuses a subprotocol that the page
// has not asked for.
TEST_F(ConsoleServerOnLoopback, GivesEveryWebSocketTheSubprotocolThatItAsksForOrNone) {
  for (int i = 0; i < 100; ++i) {
    for (const std::string name : {"foxglove.sdk.v1", "", "foxglove.websocket.v1", ""}) {
      RawClient socket = client();
      const std::string head =
          socket.get(name.empty() ? "/ws?token=abc" : "/?token=abc", upgrade(name)).head();
      ASSERT_EQ(head.find("HTTP/1.1 101"), 0U) << i << " " << head;
      const std::size_t at = head.find("Sec-WebSocket-Protocol: ");
      if (name.empty())
        ASSERT_EQ(at, std::string::npos) << i << " " << head;
      else
        ASSERT_NE(head.find("Sec-WebSocket-Protocol: " + name + "\r\n"), std::string::npos)
            << i << " " << head;
    }
    ASSERT_TRUE(wait_for_clients(0)) << i;
  }
  // A Foxglove path without a subprotocol is refused, whatever the thread had before.
  for (int i = 0; i < 100; ++i)
    ASSERT_EQ(head_of("/ws/foxglove?token=abc", upgrade()).find("HTTP/1.1 400"), 0U) << i;
}

// So that a client that goes on with requests, and reads no answers, cannot hold a thread of the server.
TEST_F(ConsoleServerOnLoopback, AConnectionHasOneRequest) {
  RawClient many = client();
  for (int i = 0; i < 20; ++i) many.get("/api/run?token=abc");
  const std::string answers = many.read_all();
  EXPECT_EQ(answers.find("HTTP/1.1 200"), 0U);
  EXPECT_NE(answers.find("\r\nConnection: close\r\n"), std::string::npos);
  EXPECT_EQ(answers.find("HTTP/1.1", 1), std::string::npos);
}

// 5 MB, of which the buffers of a connection take less.
TEST_F(ConsoleServerOnLoopback, AnAnswerThatNobodyReadsIsGivenUp) {
  for (int i = 0; i < 20'000; ++i) run_.add_step(4);
  RawClient reading = client(), unread = client(4096);
  reading.get("/api/steps?from=0&token=abc");
  unread.get("/api/steps?from=0&token=abc");
  const std::string whole = reading.read_all();
  ASSERT_GT(whole.size(), 4'500'000U);
  const auto end = Clock::now() + 30s;
  while (unread.is_connected_at_the_server() && Clock::now() < end) std::this_thread::sleep_for(50ms);
  EXPECT_LT(unread.read_all().size(), whole.size());
}

std::string masked_text(const std::string& text) {
  return "\x81" + std::string(1, static_cast<char>(0x80 | text.size())) + std::string(4, '\0') + text;
}

// 255 events a step: more than the buffers of a connection take.
void stand_still(RawClient& app, test::GrowingRun& run, std::chrono::milliseconds time) {
  app.get("/?token=abc", upgrade("foxglove.sdk.v1")).read_until("\"/figures\"");
  run.add_step();
  app.send(
      masked_text(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":3},{"id":2,"channelId":4}]})"));
  app.read_until("expected");  // the figures of the first step
  for (int i = 0; i < 200; ++i) run.add_step(255);
  std::this_thread::sleep_for(time);
}

// As in a debugger, or while a computer sleeps. A write of the server has a time-out of some seconds.
TEST_F(ConsoleServerOnLoopback, AnAppThatStandsStillForAWhileMissesNoStep) {
  RawClient app = client(4096);
  stand_still(app, run_, 9s);
  EXPECT_EQ(server_.clients(), 1);
  run_.add_step(1);
  const std::string missed = app.read_until("\"sec\":545");  // of that one alone
  std::size_t events = 0;
  for (std::size_t at = 0; (at = missed.find("\"level\"", at)) != std::string::npos; ++at) ++events;
  EXPECT_EQ(events, 200U * 255U + 1U);
  EXPECT_EQ(server_.clients(), 1);
}

// Its place is for another one.
TEST_F(ConsoleServerOnLoopback, AnAppThatStandsStillForTooLongLosesItsConnection) {
  ConsoleServer impatient(requests_, 0, 100ms);
  RawClient app(impatient.port(), 4096);
  stand_still(app, run_, 0s);
  EXPECT_EQ(impatient.clients(), 1);
  for (const auto end = Clock::now() + 30s; impatient.clients() > 0 && Clock::now() < end;)
    std::this_thread::sleep_for(20ms);
  EXPECT_EQ(impatient.clients(), 0);
}

// Not for the time that it may stand still.
TEST_F(ConsoleServerOnLoopback, AnAppThatLeavesInAMessageIsNotWaitedFor) {
  RawClient app = client(4096);
  stand_still(app, run_, 1s);
  app.finish();
  for (const auto end = Clock::now() + 30s; server_.clients() > 0 && Clock::now() < end;)
    std::this_thread::sleep_for(20ms);
  EXPECT_EQ(server_.clients(), 0);
}

// What a proxy and the server may understand differently, or what has not come whole, is not carried out.
TEST_F(ConsoleServerOnLoopback, ABodyWithoutOneSoundLengthIsRefused) {
  const std::string command = R"({"name":"NOOP","arguments":{}})";
  const std::string digits = std::to_string(command.size());
  const std::string length = "Content-Length: " + digits + "\r\n";
  const auto answer = [&](const std::string& headers, const std::string& body) {
    RawClient socket = client();
    return socket.get("/api/command?token=abc", headers, "POST").send(body).finish().read_all();
  };
  EXPECT_EQ(answer(length, command).find("HTTP/1.1 200"), 0U);
  EXPECT_EQ(run_.asked, 1);
  std::string many = length;
  for (int i = 0; i < 70; ++i) many += "X-" + std::to_string(i) + ": 1\r\n";
  const std::string filled = command + std::string(Requests::kMostBody - command.size(), ' ');
  struct Wrong {
    std::string headers, body, said;
  };
  for (const Wrong& wrong : {
           Wrong{"Content-Length: 100\r\n", command, "ended before"},
           Wrong{"Content-Length: 20000\r\n", filled, "ended before"},
           Wrong{length + "Content-Length: 100\r\n", command, "more than one"},
           Wrong{length + length, command, "more than one"},
           Wrong{many, command, "too many header fields"},
           Wrong{"", command, "no Content-Length"},
           Wrong{"Content-Length: " + digits + "abc\r\n", command, "no number"},
           Wrong{"Content-Length: +" + digits + "\r\n", command, "no number"},
           Wrong{"Content-Length: " + digits + ", 100\r\n", command, "no number"},
           Wrong{length + "Transfer-Encoding: chunked\r\n", command, "in chunks"},
       }) {
    const std::string refused = answer(wrong.headers, wrong.body);
    EXPECT_EQ(refused.find("HTTP/1.1 400"), 0U) << wrong.headers << refused;
    EXPECT_NE(refused.find(wrong.said), std::string::npos) << wrong.headers << refused;
  }
  EXPECT_EQ(answer("Content-Length: -1\r\n", command).find("HTTP/1.1 411"), 0U) << "civetweb's own";
  EXPECT_EQ(run_.asked, 1);
  EXPECT_EQ(client().get("/api/run?token=abc", "", "POST").head().find("HTTP/1.1 405"), 0U);
}

TEST_F(ConsoleServerOnLoopback, SaysWhyAPageIsRefused) {
  const std::string stranger = client().get("/ws?token=abd", upgrade()).read_all();
  EXPECT_EQ(stranger.find("HTTP/1.1 403"), 0U);
  EXPECT_NE(stranger.find("\r\n\r\n" +
                          requests_.refusal_of({"GET", "/ws", "token=abd", host(), "", ""}, server_.port())),
            std::string::npos)
      << stranger;
  std::vector<RawClient> all;
  for (int i = 0; i < ConsoleServer::kMostClients; ++i) {
    all.push_back(client());
    ASSERT_EQ(all.back().get("/ws?token=abc", upgrade()).head().find("HTTP/1.1 101"), 0U) << i;
  }
  ASSERT_TRUE(wait_for_clients(ConsoleServer::kMostClients));
  const std::string refused = client().get("/ws?token=abc", upgrade()).read_all();
  EXPECT_EQ(refused.find("HTTP/1.1 503"), 0U);
  EXPECT_NE(refused.find("as many clients as it takes"), std::string::npos);
}

TEST_F(ConsoleServerOnLoopback, AnswersWhileRequestsOfAllKindsAreNotComplete) {
  const std::string host = "Host: 127.0.0.1:" + std::to_string(server_.port()) + "\r\n";
  const std::vector<std::string> halves = {
      "",
      "G",
      "GET /?token=abc HT",
      "GET /?token=abc HTTP/1.1\r\n" + host,
      "POST /api/command?token=abd HTTP/1.1\r\n" + host + "Content-Length: 100\r\n\r\n{",
      "POST /api/command?token=abc HTTP/1.1\r\n" + host + "Content-Length: 100\r\n\r\n{",
      "POST /api/command?token=abc HTTP/1.1\r\n" + host + "Transfer-Encoding: chunked\r\n\r\n5",
  };
  for (const std::string& half : halves) {
    std::vector<RawClient> open;
    for (int i = 0; i < 200; ++i) open.push_back(std::move(client().send(half)));
    for (int i = 0; i < 3; ++i) expect_served();
  }
}

TEST_F(ConsoleServerOnLoopback, EndsConnectionsThatSendTooSlowly) {
  RawClient silent = client(), line = client(), dribbling = client(), body = client(), refused = client(),
            unasked = client(), chunked = client();
  line.send("GET / HTTP/1.1\r\n");
  body.get("/api/command?token=abc", "Content-Length: 16000\r\n", "POST");
  refused.get("/api/command?token=abd", "Content-Length: 16000\r\n", "POST");
  EXPECT_EQ(refused.head().find("HTTP/1.1 403"), 0U) << "at once: its body is not read";
  unasked.get("/api/run?token=abc", "Content-Length: 16000\r\n").head();
  chunked.get("/api/command?token=abd", "Transfer-Encoding: chunked\r\n", "POST").head();
  const auto begin = Clock::now();
  dribbling.send("GET / HTTP/1.1\r\nX: ");
  while (Clock::now() - begin < 4s) {
    dribbling.send("x");
    body.send("x");
    refused.send("x");
    unasked.send("x");
    chunked.send("1\r\nx\r\n");
    std::this_thread::sleep_for(50ms);
  }
  EXPECT_EQ(body.head().find("HTTP/1.1 400"), 0U);
  // The last ones while they still send.
  for (RawClient* one : {&refused, &unasked, &chunked}) EXPECT_TRUE(one->is_closed_within(1s));
  for (RawClient* one : {&silent, &line, &dribbling, &body}) EXPECT_TRUE(one->is_closed_within(4s));
}

TEST_F(ConsoleServerOnLoopback, AnswersWhatIsNoRequestWithAStatus) {
  const auto status_of = [this](const std::string& bytes) {
    return client().send(bytes).head().substr(9, 3);
  };
  EXPECT_EQ(status_of("\r\n\r\nHELLO\r\n\r\n"), "400");
  EXPECT_EQ(status_of("GET / HTTP/9.9\r\n\r\n"), "505");
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\n\r\n"), "403");
  EXPECT_EQ(head_of("/none?token=abc").find("HTTP/1.1 404"), 0U);
  const std::string start = "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: ";
  EXPECT_EQ(head_of("/ws?token=abc", start + "8\r\nSec-WebSocket-Key: x\r\n").find("HTTP/1.1 426"), 0U);
  EXPECT_EQ(head_of("/ws?token=abc", start + "13\r\n").find("HTTP/1.1 400"), 0U);
  const std::string wrong = client().get("/api/command?token=abc").head();
  EXPECT_EQ(wrong.find("HTTP/1.1 405"), 0U);
  EXPECT_NE(wrong.find("Allow: POST\r\n"), std::string::npos);
  RawClient large = client();
  large.get("/api/command?token=abc", "Content-Length: 20000\r\n", "POST").send(std::string(20'000, ' '));
  EXPECT_EQ(large.head().find("HTTP/1.1 413"), 0U);
  expect_served();
}

// In a thread of the server, whose stack is small.
TEST_F(ConsoleServerOnLoopback, DeepJsonIsRefused) {
  const std::string deep = "{\"arguments\":" + std::string(8'000, '[') + std::string(8'000, ']') + "}";
  RawClient sent = client();
  sent.get("/api/command?token=abc", "Content-Length: " + std::to_string(deep.size()) + "\r\n", "POST")
      .send(deep);
  EXPECT_NE(sent.read_until("deep").find("HTTP/1.1 400"), std::string::npos);
  RawClient socket = client();
  socket.get("/?token=abc", upgrade("foxglove.sdk.v1")).read_until("\"/figures\"");
  const std::string brackets(60'000, '[');
  socket.send(
      "\x81\xFE" +
      std::string{static_cast<char>(brackets.size() >> 8), static_cast<char>(brackets.size() & 0xFF)} +
      std::string(4, '\0') + brackets);
  EXPECT_NE(socket.read_until(" deep\"").find("nested more than 16"), std::string::npos);
  expect_served();
}

}  // namespace
}  // namespace tumblesight::sim
