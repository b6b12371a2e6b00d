// The console beside a real run: it sees what the run sends and gets, and the run does not notice it.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>

#include "sim/console/bus_run.hpp"
#include "sim/console/console_server.hpp"
#include "sim/console/foxglove_session.hpp"
#include "sim/console/recorded_run.hpp"
#include "sim/recording/frames_file.hpp"
#include "sim/sil/domain_lease.hpp"
#include "sim/sil/simulated_steps.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kConsoleSteps = 20;

SilRunResult run(const std::string& mcap_path) {
  return test::run_shipped(mcap_path, kConsoleSteps / 10);
}

void expect_the_steps(const SilRunResult& run, const RunSource& source, std::uint32_t first) {
  const StepLog& log = source.log();
  ASSERT_EQ(log.state().steps, kConsoleSteps - first);
  EXPECT_TRUE(log.state().has_ended);
  for (std::uint32_t i = 0; i + first < kConsoleSteps; ++i) {
    const StepResult& step = run.steps[i + first];
    const Json detail = log.step(i);
    EXPECT_EQ(detail["telemetry"]["frames_used"], step.telemetry.frames_used);
    EXPECT_NEAR(detail["network"]["q"][0].get<double>(), step.attitude.q_lrf_trf[0] / 1073741824.0, 1e-8);
    EXPECT_NEAR(detail["truth"]["range_m"].get<double>(), step.truth.range_m, 1e-4);
    gnc::RangeImage frame;
    ASSERT_TRUE(source.frame(i, frame)) << i;
    EXPECT_EQ(frame.exposure_time_ns, step.attitude.exposure_time_ns);
  }
}

template <class Condition>
bool wait_until(const Condition& condition) {
  for (int i = 0; i < 500; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(20ms);
  }
  return false;
}

TEST(Console, ShowsEveryStepOfARecordingWithItsFrame) {
  const std::string path = test::temporary_path("run.mcap");
  const SilRunResult recorded = run(path);
  ASSERT_EQ(recorded.failure, "");
  const RecordedRun shown(path);
  EXPECT_TRUE(shown.is_whole());
  EXPECT_EQ(shown.log().target(), "near_shoemaker");
  expect_the_steps(recorded, shown, 0);
}

// A flight program on its own timer.
TEST(Console, ShowsTheFramesOfAFreeRun) {
  const std::string path = test::temporary_path("run.mcap");
  SilSettings settings = test::shipped_settings(path);
  settings.free_running = true;
  settings.speed = 10;
  ASSERT_EQ(run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {}).failure, "");
  const RecordedRun shown(path);
  std::uint64_t frames = 0;
  gnc::RangeImage frame;
  for (std::uint64_t i = 0; i < shown.log().state().steps; ++i) frames += shown.frame(i, frame) ? 1 : 0;
  EXPECT_GE(frames, 8U);
}

TEST(Console, ShowsFramesThatNoFlightProgramHasSeen) {
  const std::string path = test::temporary_path("frames.mcap");
  const std::vector<Sequence> sequences = test::sequences(kConsoleSteps / 10, 1);
  SimulatedSteps source(test::lidar(), test::kSwath_m, sequences, true);
  write_frames_file(path, source, "near_shoemaker", 5, test::kSwath_m);
  const RecordedRun shown(path);
  ASSERT_EQ(shown.log().state().steps, kConsoleSteps);
  for (std::uint32_t k = 0; k < kConsoleSteps; ++k) {
    gnc::RangeImage frame;
    EXPECT_TRUE(shown.frame(k, frame)) << k;
    EXPECT_EQ(frame.sequence_number, k);
    EXPECT_NEAR(shown.log().step(k)["truth"]["range_m"].get<double>(),
                sequences[k / 10].frames[k % 10].range_m, 1e-4);
    EXPECT_TRUE(shown.log().step(k)["network"].is_null());
  }
}

TEST(Console, ShowsARecordingWithoutItsEnd) {
  const std::string path = test::temporary_path("run.mcap");
  ASSERT_EQ(run(path).failure, "");
  const std::string bytes = test::read_file(path);
  // The writer was killed behind its first chunk, which has a mebibyte.
  constexpr std::ptrdiff_t kLeft = 1'250'000;
  ASSERT_GT(bytes.size(), kLeft + 10'000);
  test::write_file(path, {bytes.begin(), bytes.begin() + kLeft});
  const RecordedRun shown(path);
  EXPECT_FALSE(shown.is_whole());
  EXPECT_GT(shown.log().state().steps, 2U);
  EXPECT_LT(shown.log().state().steps, kConsoleSteps);
}

TEST(Console, SaysThatARecordingWasCutOffBeforeItsFirstMessages) {
  const std::string path = test::temporary_path("run.mcap");
  ASSERT_EQ(run(path).failure, "");
  const std::string bytes = test::read_file(path);
  for (const std::ptrdiff_t left : {36, 2'000, 100'000, 500'000}) {
    test::write_file(path, {bytes.begin(), bytes.begin() + left});
    try {
      const RecordedRun shown(path);
      FAIL() << left;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("was cut off before"), std::string::npos) << error.what();
    }
  }
}

// Another program writes over it.
TEST(Console, ARecordingThatBecomesShorterIsRefusedFromThenOn) {
  const std::string path = test::temporary_path("run.mcap");
  ASSERT_EQ(run(path).failure, "");
  const RecordedRun shown(path);
  ASSERT_EQ(truncate(path.c_str(), 5000), 0);
  gnc::RangeImage frame;
  EXPECT_THROW((void)shown.frame(kConsoleSteps - 1, frame), std::runtime_error);
}

TEST(Console, RefusesAFileThatIsNoRecordingOfARunByName) {
  const std::string path = test::temporary_path("other.mcap");
  McapWriter(path, "test").close();
  for (const std::string& wrong : {path, std::string("/none/run.mcap"), std::string(TUMBLESIGHT_IDL)}) {
    try {
      const RecordedRun shown(wrong);
      FAIL() << wrong;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(wrong), std::string::npos) << error.what();
    }
  }
}

TEST(Console, RefusesARecordingOfAnotherInterface) {
  const std::string path = test::temporary_path("run.mcap");
  ASSERT_EQ(run(path).failure, "");
  std::string bytes = test::read_file(path);
  // Every copy of the interface says 16385 ranges.
  for (std::size_t at = bytes.find("RANGES = 16384"); at != std::string::npos;
       at = bytes.find("RANGES = 16384", at + 1))
    bytes[at + 13] = '5';
  // Without its end the checksum over the whole file is not looked at.
  bytes.resize(bytes.size() * 3 / 4);
  test::write_file(path, {bytes.begin(), bytes.end()});
  try {
    const RecordedRun shown(path);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("another version of the interface"), std::string::npos)
        << error.what();
  }
}

// Verifies TS-SIL-195. It may miss the first steps, since the run does not wait for it.
TEST(Console, FollowsARunWithoutChangingIt) {
  const int domain = test::spare_domain();
  const std::string alone = test::simulate("");
  const BusRun shown(domain, "");
  const std::string watched = test::simulate("--speed 20 --domain " + std::to_string(domain));
  EXPECT_EQ(test::trace_of(watched), test::trace_of(alone));
  ASSERT_TRUE(wait_until([&] { return shown.log().state().has_ended; }));
  const StepLog::State state = shown.log().state();
  EXPECT_GE(state.steps, kConsoleSteps / 2);
  EXPECT_EQ(shown.log().k_of(state.steps - 1), kConsoleSteps - 1);
  const Json rows = shown.log().rows(0)["rows"];
  for (std::uint64_t i = 1; i < state.steps; ++i) {
    gnc::RangeImage frame;
    EXPECT_TRUE(shown.frame(i, frame)) << i;
    EXPECT_FALSE(rows[i][6].is_null()) << i;  // the error needs attitude and truth
  }
}

// While a run prepares its topics, the file of the one that was killed in its domain is still there.
TEST(Console, WaitsForTheRunAfterAKilledOne) {
  const int domain = test::spare_domain();
  test::leave_announcement_of_killed_run(domain);
  const BusRun shown(domain, "");
  {
    const DomainLease prepared(domain);
    std::this_thread::sleep_for(300ms);
  }
  test::simulate("--speed 20 --domain " + std::to_string(domain));
  ASSERT_TRUE(wait_until([&] { return shown.log().state().has_ended; }));
  EXPECT_GE(shown.log().state().steps, kConsoleSteps / 2);
}

TEST(Console, LeavesARunThatItCannotReachForANewerOne) {
  const int domain = test::spare_domain();
  const DomainLease lease(domain);
  const int other_domain = test::spare_domain();
  // The announcements of this test are in a folder of their own, so that no other run is newer.
  const std::string folder = test::temporary_path("runs");
  std::filesystem::create_directories(folder);
  std::filesystem::permissions(folder, std::filesystem::perms::owner_all);
  const test::Environment runs("XDG_RUNTIME_DIR", folder);
  hal::dds::RunSecret secret;
  ASSERT_TRUE(hal::dds::make_run_secret(secret));
  const RunAnnouncement unreachable(static_cast<std::uint32_t>(domain), secret);
  const std::string path = test::temporary_path("newer.mcap");
  {
    const BusRun shown(-1, "", path);
    ASSERT_TRUE(wait_until([&] { return !shown.failure().empty(); }));
    EXPECT_NE(shown.failure().find("the run in DDS domain " + std::to_string(domain) + " is announced, but"),
              std::string::npos)
        << shown.failure();
    test::simulate("--speed 20 --domain " + std::to_string(other_domain));
    ASSERT_TRUE(wait_until([&] { return shown.log().state().steps > 0 && shown.log().state().has_ended; }));
    EXPECT_GE(shown.log().state().steps, kConsoleSteps / 2);
  }
  EXPECT_GE(RecordedRun(path).log().state().steps, kConsoleSteps / 2) << "recorded is the run that was seen";
}

// Topics are joined one after the other: of the first steps a part may be in the recording only, or missing.
TEST(Console, RecordsTheRunThatItHasJoined) {
  const int domain = test::spare_domain();
  const std::string path = test::temporary_path("joined.mcap");
  std::uint64_t steps = 0;
  {
    const BusRun shown(domain, "", path);
    // Slow enough that half of it is left when a busy machine has joined all topics.
    test::simulate("--speed 8 --domain " + std::to_string(domain));
    ASSERT_TRUE(wait_until([&] { return shown.log().state().has_ended; }));
    steps = shown.log().state().steps;
    EXPECT_EQ(shown.failure(), "");
  }
  const RecordedRun recorded(path);
  EXPECT_TRUE(recorded.is_whole());
  const std::uint64_t recorded_steps = recorded.log().state().steps;
  EXPECT_GE(recorded_steps, steps);
  EXPECT_LE(recorded_steps, kConsoleSteps);
  EXPECT_EQ(recorded.log().k_of(recorded_steps - 1), kConsoleSteps - 1);
  const McapReader reader(path);
  for (const char* topic : {"/figures", "/tf", "/lidar/points"})
    EXPECT_GE(reader.entries(reader.find(topic)->id).size(), kConsoleSteps / 2) << topic;
  gnc::RangeImage frame;
  EXPECT_TRUE(recorded.frame(recorded_steps - 1, frame));
}

TEST(Console, ShowsARunWhoseRecordingCannotBeWritten) {
  const int domain = test::spare_domain();
  const BusRun shown(domain, "", "/dev/full");
  test::simulate("--speed 50 --domain " + std::to_string(domain));
  ASSERT_TRUE(wait_until([&] { return shown.log().state().has_ended; }));
  EXPECT_GE(shown.log().state().steps, kConsoleSteps / 2);
  EXPECT_NE(shown.failure().find("/dev/full"), std::string::npos) << shown.failure();
}

TEST(Console, ShowsTheNextRunAfterTheOneBefore) {
  const int domain = test::spare_domain();
  const BusRun shown(domain, "");
  EXPECT_EQ(shown.title(), "waiting for a run: start sim/run or tumblesight simulate");
  test::simulate("--speed 100 --domain " + std::to_string(domain));
  ASSERT_TRUE(wait_until([&] { return shown.log().state().has_ended; }));
  const std::uint32_t before = shown.log().state().run_id;
  test::simulate("--speed 100 --domain " + std::to_string(domain));
  EXPECT_TRUE(
      wait_until([&] { return shown.log().state().has_ended && shown.log().state().run_id != before; }));
}

// A connection as a browser makes it.
class Connection {
 public:
  Connection(int port, const std::string& target, const std::string& headers = "") {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socket_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const timeval limit{5, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return;
    const std::string request =
        "GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n" + headers + "\r\n";
    (void)write(socket_, request.data(), request.size());
  }
  ~Connection() { close(socket_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  void send(const std::string& bytes) { (void)!write(socket_, bytes.data(), bytes.size()); }
  // What comes until it has this text, or nothing more comes.
  std::string read_until(const std::string& text) {
    char buffer[4096];
    while (received_.find(text) == std::string::npos) {
      const ssize_t count = read(socket_, buffer, sizeof buffer);
      if (count <= 0) break;
      received_.append(buffer, static_cast<std::size_t>(count));
    }
    return received_;
  }

 private:
  int socket_ = -1;
  std::string received_;
};
constexpr const char* kUpgrade =
    "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";

// A client over the network, as a browser is one.
class Served : public testing::Test {
 protected:
  Served() {
    const std::string path = test::temporary_path("run.mcap");
    EXPECT_EQ(run(path).failure, "");
    run_ = std::make_unique<RecordedRun>(path);
    requests_ = std::make_unique<Requests>(
        *run_, [](const std::string&) { return TUMBLESIGHT_SHIPPED_MODEL; }, "abc");
    server_ = std::make_unique<ConsoleServer>(*requests_, 0);
  }
  bool is_told(Connection& socket) const {
    return socket.read_until("\"steps\":20").find("\"steps\":20") != std::string::npos;
  }
  std::unique_ptr<RecordedRun> run_;
  std::unique_ptr<Requests> requests_;
  std::unique_ptr<ConsoleServer> server_;
};

TEST_F(Served, IsToldOfTheStateOverItsWebSocket) {
  Connection socket(server_->port(), "/ws?token=abc", kUpgrade);
  EXPECT_TRUE(is_told(socket)) << socket.read_until("\n");
}

TEST_F(Served, WithoutATokenOrFromAnotherPageThereIsNoWebSocket) {
  for (const char* target : {"/ws?token=abd", "/ws"}) {
    Connection socket(server_->port(), target, kUpgrade);
    EXPECT_EQ(socket.read_until("\r\n").find("HTTP/1.1 101"), std::string::npos);
  }
  Connection foreign(server_->port(), "/ws?token=abc", std::string(kUpgrade) + "Origin: http://evil\r\n");
  EXPECT_EQ(foreign.read_until("\r\n").find("HTTP/1.1 101"), std::string::npos);
}

// None of them reads. The page and its data are answered beside them.
TEST_F(Served, MoreClientsThanItTakesAreRefusedAndThePageIsAnswered) {
  std::vector<std::unique_ptr<Connection>> sockets;
  for (int i = 0; i < ConsoleServer::kMostClients; ++i)
    sockets.push_back(std::make_unique<Connection>(server_->port(), "/ws?token=abc", kUpgrade));
  ASSERT_TRUE(wait_until([&] { return server_->clients() == ConsoleServer::kMostClients; }));
  Connection more(server_->port(), "/ws?token=abc", kUpgrade);
  EXPECT_EQ(more.read_until("\r\n").find("HTTP/1.1 101"), std::string::npos);
  Connection page(server_->port(), "/?token=abc");
  EXPECT_NE(page.read_until("</html>").find("HTTP/1.1 200"), std::string::npos);
  sockets.clear();
  EXPECT_TRUE(wait_until([&] { return server_->clients() == 0; }));
}

std::string foxglove(const std::string& subprotocol, const std::string& origin = "") {
  return kUpgrade + ("Sec-WebSocket-Protocol: " + subprotocol + "\r\n") +
         (origin.empty() ? "" : "Origin: " + origin + "\r\n");
}

// A frame of a client as RFC 6455 has it. With a mask of zeros the bytes stay as they are.
std::string frame_of_client(char opcode, const std::string& bytes) {
  std::string frame{static_cast<char>(0x80 | opcode),
                    static_cast<char>(0x80 | (bytes.size() < 126 ? bytes.size() : 127))};
  if (bytes.size() >= 126)
    for (int i = 7; i >= 0; --i) frame += static_cast<char>((bytes.size() >> (8 * i)) & 0xFF);
  return frame + std::string(4, '\0') + bytes;
}

TEST_F(Served, FoxgloveAttachesByEachNameOfItsProtocol) {
  for (const std::string path : {"/?token=abc", "/ws/foxglove?token=abc"}) {
    for (const std::string protocol : {"foxglove.sdk.v1", "foxglove.websocket.v1"}) {
      // The apps offer both, and have an origin of their own.
      Connection socket(server_->port(), path, foxglove("other.v1, " + protocol, "https://app.foxglove.dev"));
      const std::string begin = socket.read_until("\"/figures\"");
      EXPECT_NE(begin.find("HTTP/1.1 101"), std::string::npos) << begin;
      EXPECT_NE(begin.find("Sec-WebSocket-Protocol: " + protocol + "\r\n"), std::string::npos) << begin;
      EXPECT_NE(begin.find("\"op\":\"serverInfo\""), std::string::npos) << begin;
      EXPECT_NE(begin.find("\"op\":\"advertise\""), std::string::npos) << begin;
      socket.send(frame_of_client(
          1, R"({"op":"subscribe","subscriptions":[{"id":9,"channelId":4},{"id":10,"channelId":1}]})"));
      const std::string data = socket.read_until("\"frame_id\"");
      EXPECT_NE(data.find("\"true_range_m\""), std::string::npos);
      EXPECT_NE(data.find(std::string("\x01\x09\0\0\0", 5)), std::string::npos);
      EXPECT_NE(data.find("\"frame_id\""), std::string::npos);
    }
  }
}

TEST_F(Served, FoxgloveIsRefusedWithoutTheTokenOrItsProtocol) {
  const auto answer = [this](const std::string& target, const std::string& headers) {
    return Connection(server_->port(), target, headers).read_until("\r\n");
  };
  const std::string origin = "https://app.foxglove.dev";
  for (const char* target : {"/?token=abd", "/", "/ws/foxglove"})
    EXPECT_EQ(answer(target, foxglove("foxglove.sdk.v1", origin)).find("HTTP/1.1 403"), 0U) << target;
  for (const std::string& headers : {foxglove("other.v1", origin), std::string(kUpgrade)})
    EXPECT_EQ(answer("/?token=abc", headers).find("HTTP/1.1 400"), 0U) << headers;
  // The page's own WebSocket has no use for the name.
  EXPECT_EQ(answer("/ws?token=abc", foxglove("foxglove.sdk.v1", origin)).find("HTTP/1.1 101"),
            std::string::npos);
  EXPECT_EQ(server_->clients(), 0);
}

TEST_F(Served, FoxgloveIsAnsweredAndEndsAtTooLongAMessage) {
  Connection socket(server_->port(), "/?token=abc", foxglove("foxglove.sdk.v1"));
  socket.read_until("\"/figures\"");
  socket.send(frame_of_client(9, "still there"));
  EXPECT_NE(socket.read_until("still there").find("\x8A\x0Bstill there"), std::string::npos);
  socket.send(frame_of_client(1, R"({"op":"getParameters"})"));
  EXPECT_NE(socket.read_until("no other op").find("\"level\":1"), std::string::npos);
  EXPECT_EQ(server_->clients(), 1);
  socket.send(frame_of_client(1, std::string(FoxgloveSession::kMostBytes + 1, 'x')));
  EXPECT_TRUE(wait_until([&] { return server_->clients() == 0; }));
}

TEST_F(Served, APortThatIsTakenIsNamedWithTheRemedy) {
  try {
    const ConsoleServer second(*requests_, server_->port());
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(std::to_string(server_->port())), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("--port"), std::string::npos);
  }
}

}  // namespace
}  // namespace tumblesight::sim
