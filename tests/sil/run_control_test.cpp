// Requests into a run that goes on.
#include "sim/sil/run_control.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <future>
#include <thread>

#include "sim/sil/domain_lease.hpp"
#include "sim/sil/failure.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

class Control : public testing::Test {
 protected:
  Control() : lease_(test::spare_domain()), control_(std::make_unique<RunControl>(lease_.domain())) {}
  std::string path() const {
    return std::filesystem::temp_directory_path().string() + "/tumblesight-domain-" +
           std::to_string(lease_.domain()) + ".control";
  }
  // As a console asks while the run goes on.
  std::string ask(const std::string& request) {
    auto answer = std::async(std::launch::async, [&] { return ask_run(lease_.domain(), request, 5000); });
    while (answer.wait_for(std::chrono::milliseconds(2)) != std::future_status::ready)
      for (Telecommand& command : control_->take(41, faults_)) commands_.push_back(std::move(command));
    return answer.get();
  }

  DomainLease lease_;
  std::unique_ptr<RunControl> control_;
  FrameFaults faults_;
  std::vector<Telecommand> commands_;
};

TEST_F(Control, TakesATelecommandAndSaysInWhichStep) {
  EXPECT_EQ(ask(R"({"function":3,"arguments":"02"})"), R"({"step":41})");
  ASSERT_EQ(commands_.size(), 1U);
  EXPECT_EQ(commands_[0].function, hal::FunctionCode::kSetMode);
  EXPECT_EQ(commands_[0].arguments, std::vector<std::uint8_t>{2});
}

TEST_F(Control, TakesAFault) {
  EXPECT_EQ(ask(R"({"fault":"drop","steps":2})"), R"({"step":41})");
  gnc::RangeImage frame{};
  StepInput input;
  input.frames = {&frame};
  FrameTruth truth{};
  faults_.apply(input, truth);
  EXPECT_TRUE(input.frames.empty());
}

TEST_F(Control, RefusesWhatIsNoRequest) {
  for (const char* request :
       {"", "x", "[]", "{}", R"({"function":128,"arguments":""})", R"({"function":-1,"arguments":""})",
        R"({"function":1})", R"({"function":1,"arguments":"0"})", R"({"function":1,"arguments":"gg"})",
        R"({"function":"NOOP","arguments":""})", R"({"fault":"melt","steps":1})",
        R"({"fault":"drop","steps":0})", R"({"fault":"drop","steps":1001})", R"({"fault":"drop"})",
        R"({"fault":1,"steps":1})"}) {
    EXPECT_EQ(ask(request).find(R"({"error":)"), 0U) << request;
  }
  EXPECT_EQ(ask(R"({"function":1,"arguments":")" + std::string(2 * 1029, '0') + "\"}").find(R"({"error":)"),
            0U);
  EXPECT_TRUE(commands_.empty());
}

TEST_F(Control, IsForItsOwnerAlone) {
  struct stat status {};
  ASSERT_EQ(stat(path().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST_F(Control, EndsWithTheRun) {
  control_.reset();
  EXPECT_FALSE(std::filesystem::exists(path()));
  EXPECT_THROW(ask_run(lease_.domain(), "{}", 100), SilFailure);
}

TEST_F(Control, AnAnswerIsNotWaitedForWithoutEnd) {
  EXPECT_THROW(ask_run(lease_.domain(), "{}", 50), SilFailure);
}

// A client that never ends its line, one that never reads, and more than there is room for.
TEST_F(Control, ClientsThatMisbehaveDoNotStopTheRun) {
  std::vector<int> sockets;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path().data(), path().size());
  for (std::size_t i = 0; i < RunControl::kMostClients + 4; ++i) {
    sockets.push_back(socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    // Not all of them find room to wait.
    (void)connect(sockets.back(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
    const std::string flood = i % 2 == 0 ? std::string(20'000, 'x') : "x\nx\nx\nx\n";
    (void)send(sockets.back(), flood.data(), flood.size(), MSG_NOSIGNAL);
  }
  for (std::uint32_t step = 0; step < 10; ++step) EXPECT_TRUE(control_->take(step, faults_).empty());
  for (const int one : sockets) close(one);
  control_->take(10, faults_);
  EXPECT_EQ(ask(R"({"function":1,"arguments":""})"), R"({"step":41})");
}

}  // namespace
}  // namespace tumblesight::sim
