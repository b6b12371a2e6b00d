// Requests into a run that goes on.
#include "sim/sil/run_control.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <filesystem>
#include <future>
#include <thread>

#include "sim/operations/request_line.hpp"
#include "sim/sil/domain_lease.hpp"
#include "sim/sil/failure.hpp"
#include "sim/sil/runtime_folder.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

// Frames that cannot be rendered anew, but for one fault.
class Source final : public StepSource {
 public:
  std::uint32_t steps() const override { return 0; }
  std::int64_t time_ns(std::uint32_t) const override { return 0; }
  SourcedStep next() override { return {}; }
  void begin_fault(const InjectedFault& fault) override {
    if (fault.name != "debris") return StepSource::begin_fault(fault);
    begun.push_back(fault);
  }
  bool takes_telecommands() const override { return takes; }
  std::vector<InjectedFault> begun;
  bool takes = true;
};

class Control : public testing::Test {
 protected:
  Control() : lease_(test::spare_domain()), control_(std::make_unique<RunControl>(lease_.domain())) {}
  std::string path() const {
    return RuntimeFolder().path_of("domain-" + std::to_string(lease_.domain()) + ".control");
  }
  // As a console asks while the run goes on.
  std::string ask(const std::string& request) {
    auto answer = std::async(std::launch::async, [&] { return ask_run(lease_.domain(), request, 5000); });
    while (answer.wait_for(std::chrono::milliseconds(2)) != std::future_status::ready)
      for (Telecommand& command : control_->take(41, faults_, source_).commands)
        commands_.push_back(std::move(command));
    return answer.get();
  }

  DomainLease lease_;
  std::unique_ptr<RunControl> control_;
  FrameFaults faults_;
  Source source_;
  std::vector<Telecommand> commands_;
  std::atomic<int> busy_{0};
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

TEST_F(Control, TakesAFaultOfTheScene) {
  EXPECT_EQ(ask(R"({"fault":"debris","strength":1.5,"steps":2})"), R"({"step":41})");
  ASSERT_EQ(source_.begun.size(), 1U);
  EXPECT_EQ(source_.begun[0].strength, 1.5);
  EXPECT_EQ(source_.begun[0].steps, 2U);
}

TEST_F(Control, SaysThatRecordedFramesCannotBeRendered) {
  EXPECT_NE(ask(R"({"fault":"occlude","strength":0.5,"steps":2})").find("only drop, freeze and delay"),
            std::string::npos);
}

TEST_F(Control, AddsNoTelecommandToRecordedOnes) {
  source_.takes = false;
  EXPECT_NE(ask(R"({"function":1,"arguments":""})").find("are recorded"), std::string::npos);
  EXPECT_TRUE(commands_.empty());
}

// Its user was told that it failed.
TEST_F(Control, DoesNotCarryOutWhatNobodyWaitsFor) {
  EXPECT_THROW(ask_run(lease_.domain(), R"({"function":1,"arguments":""})", 20), SilFailure);
  EXPECT_THROW(ask_run(lease_.domain(), R"({"fault":"debris","strength":1,"steps":1})", 20), SilFailure);
  EXPECT_TRUE(control_->take(41, faults_, source_).commands.empty());
  EXPECT_TRUE(source_.begun.empty());
}

// A run that is paused, and more who ask than can wait.
TEST_F(Control, NobodyWaitsForEver) {
  std::vector<std::future<void>> all;
  for (int i = 0; i < 24; ++i)
    all.push_back(std::async(std::launch::async, [this] {
      EXPECT_THROW(ask_run(lease_.domain(), R"({"function":1,"arguments":""})", 50), SilFailure);
    }));
  for (std::future<void>& one : all)
    ASSERT_EQ(one.wait_for(std::chrono::seconds(5)), std::future_status::ready);
}

TEST_F(Control, LimitsTheFaultsOfAStep) {
  const int client = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path().data(), path().size());
  ASSERT_EQ(connect(client, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  const std::string line = "{\"fault\":\"debris\",\"strength\":1,\"steps\":1}\n";
  std::string lines;
  for (std::size_t i = 0; i < RunControl::kMostFaults + 3; ++i) lines += line;
  ASSERT_EQ(send(client, lines.data(), lines.size(), MSG_NOSIGNAL), static_cast<ssize_t>(lines.size()));
  EXPECT_EQ(control_->take(41, faults_, source_).faults.size(), RunControl::kMostFaults);
  EXPECT_EQ(source_.begun.size(), RunControl::kMostFaults);
  close(client);
}

TEST_F(Control, RefusesWhatIsNoRequest) {
  for (const char* request : {"",
                              "x",
                              "[]",
                              "{}",
                              R"({"function":128,"arguments":""})",
                              R"({"function":-1,"arguments":""})",
                              R"({"function":1})",
                              R"({"function":1,"arguments":"0"})",
                              R"({"function":1,"arguments":"gg"})",
                              R"({"function":"NOOP","arguments":""})",
                              R"({"fault":"melt","steps":1})",
                              R"({"fault":"drop","steps":0})",
                              R"({"fault":"drop","steps":1001})",
                              R"({"fault":"drop"})",
                              R"({"fault":1,"steps":1})",
                              R"({"fault":"debris","steps":1})",
                              R"({"fault":"debris","strength":"1","steps":1})",
                              R"({"fault":"debris","strength":11,"steps":1})",
                              R"({"fault":"debris","strength":1e999,"steps":1})",
                              R"({"fault":"drop","strength":1,"steps":1})",
                              R"({"fault":"panel_turn","strength":10,"steps":1})",
                              R"({"fault":"drop","steps":18446744073709551615})",
                              R"({"fault":"drop","steps":4294967301})",
                              R"({"fault":"drop","steps":2.5})",
                              R"({"fault":"drop","steps":true})",
                              R"({"function":4294967299,"arguments":"02"})",
                              R"({"function":3.5,"arguments":"02"})"}) {
    EXPECT_EQ(ask(request).find(R"({"error":)"), 0U) << request;
  }
  EXPECT_EQ(ask(R"({"function":1,"arguments":")" + std::string(2 * 1029, '0') + "\"}").find(R"({"error":)"),
            0U);
  EXPECT_TRUE(commands_.empty());
}

// Who asks reads the same before.
TEST_F(Control, NamesTheValueThatItRefuses) {
  struct Wrong {
    const char *request, *said;
  };
  for (const Wrong& wrong : {
           Wrong{R"({"function":128,"arguments":""})", "from 0 to 127, not 128"},
           Wrong{R"({"function":-1,"arguments":""})", "not -1"},
           Wrong{R"({"function":1.5,"arguments":""})", "not 1.5"},
           Wrong{R"({"function":18446744073709551616,"arguments":""})", "not 1.8446744073709552e+19"},
           Wrong{R"({"function":4294967299,"arguments":""})", "not 4294967299"},
           Wrong{R"({"function":1,"arguments":"0"})", "not '0'"},
           Wrong{R"({"function":1,"arguments":"zz"})", "not 'zz'"},
           Wrong{R"({"fault":"melt","steps":1})", "there is no fault 'melt'"},
           Wrong{R"({"fault":"drop","steps":0})", "from 1 to 1000, not 0"},
           Wrong{R"({"fault":"drop","steps":-1})", "not -1"},
           Wrong{R"({"fault":"drop","steps":1001})", "not 1001"},
           Wrong{R"({"fault":"drop","steps":2.5})", "not 2.5"},
           Wrong{R"({"fault":"drop","steps":1e300})", "not 1e+300"},
           Wrong{R"({"fault":"drop","steps":9223372036854775808})", "not 9223372036854775808"},
           Wrong{R"({"fault":"drop","strength":7,"steps":1})", "leave out 7"},
           Wrong{R"({"fault":"debris","steps":1})", "needs a strength, a number from 0.1 to 10 m"},
           Wrong{R"({"fault":"debris","strength":"1","steps":1})", "not \"1\""},
           Wrong{R"({"fault":"debris","strength":11,"steps":1})", "not 11"},
       }) {
    try {
      read_request_line(wrong.request);
      ADD_FAILURE() << wrong.request;
    } catch (const std::invalid_argument& refusal) {
      EXPECT_NE(std::string(refusal.what()).find(wrong.said), std::string::npos) << refusal.what();
    }
  }
}

// Several pages, or a script. The run takes eight in a step.
TEST_F(Control, TakesManyRequestsAtOnce) {
  std::vector<std::future<std::string>> all;
  for (int i = 0; i < 40; ++i)
    all.push_back(std::async(std::launch::async, [this] {
      return ask_run(lease_.domain(), R"({"function":1,"arguments":""})", 5000);
    }));
  for (std::uint32_t step = 0; step < 400 && commands_.size() < all.size(); ++step) {
    for (Telecommand& command : control_->take(step, faults_, source_).commands)
      commands_.push_back(std::move(command));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  for (std::future<std::string>& one : all) EXPECT_EQ(one.get().find(R"({"step":)"), 0U);
}

TEST_F(Control, SaysWhenTooManyWait) {
  std::vector<std::future<void>> all;
  for (int i = 0; i < 24; ++i)
    all.push_back(std::async(std::launch::async, [this] {
      try {
        ask_run(lease_.domain(), R"({"function":1,"arguments":""})", 300);
        ADD_FAILURE() << "answered";
      } catch (const RunIsBusy& busy) {
        EXPECT_NE(std::string(busy.what()).find("send it again"), std::string::npos);
        ++busy_;
      } catch (const SilFailure& paused) {
        EXPECT_NE(std::string(paused.what()).find("it is paused"), std::string::npos) << paused.what();
      }
    }));
  all.clear();
  EXPECT_GT(busy_, 0);
  EXPECT_LT(busy_, 24);
}

// Nothing else removes it, and the run goes on.
TEST_F(Control, SaysWhatStandsInTheWayOfItsSocket) {
  control_.reset();
  std::filesystem::create_directory(path());
  control_ = std::make_unique<RunControl>(lease_.domain());
  EXPECT_NE(control_->failure().find(path()), std::string::npos) << control_->failure();
  EXPECT_NE(control_->failure().find("remove"), std::string::npos) << control_->failure();
  EXPECT_TRUE(control_->take(0, faults_, source_).commands.empty());
  try {
    ask_run(lease_.domain(), "{}", 100);
    ADD_FAILURE() << "answered";
  } catch (const SilFailure& failure) {
    EXPECT_NE(std::string(failure.what()).find(path() + ": this is no socket: remove it"), std::string::npos)
        << failure.what();
  }
  control_.reset();
  EXPECT_TRUE(std::filesystem::is_directory(path()));
  std::filesystem::remove(path());
}

// A path of a socket has at most 107 bytes.
TEST_F(Control, IsThereInAFolderWithALongName) {
  control_.reset();
  const std::string folder = test::temporary_path(std::string(120, 'x'));
  std::filesystem::create_directories(folder);
  std::filesystem::permissions(folder, std::filesystem::perms::owner_all);
  const test::Environment place("XDG_RUNTIME_DIR", folder);
  control_ = std::make_unique<RunControl>(lease_.domain());
  EXPECT_EQ(control_->failure(), "");
  EXPECT_EQ(path().find(folder), 0U);
  EXPECT_EQ(ask(R"({"function":1,"arguments":""})"), R"({"step":41})");
  control_.reset();
  EXPECT_FALSE(std::filesystem::exists(path()));
  EXPECT_THROW(ask_run(lease_.domain(), "{}", 100), SilFailure);
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

// Nobody waits for what is no socket.
TEST_F(Control, WhoseNameIsTakenByAFifoIsMadeAllTheSame) {
  control_.reset();
  ASSERT_EQ(mkfifo(path().c_str(), 0600), 0);
  EXPECT_THROW(ask_run(lease_.domain(), "{}", 100), SilFailure);
  control_ = std::make_unique<RunControl>(lease_.domain());
  EXPECT_EQ(ask(R"({"function":1,"arguments":""})"), R"({"step":41})");
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
  for (std::uint32_t step = 0; step < 10; ++step)
    EXPECT_TRUE(control_->take(step, faults_, source_).commands.empty());
  for (const int one : sockets) close(one);
  control_->take(10, faults_, source_);
  EXPECT_EQ(ask(R"({"function":1,"arguments":""})"), R"({"step":41})");
}

}  // namespace
}  // namespace tumblesight::sim
