// The answers to the page's requests, and who gets none.
// Verifies TS-SIL-195.
#include "sim/console/requests.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "hal/dds/idl/hello.hpp"
#include "sim/sil/run_control.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kPort = 7320;
const std::string kToken = "0123456789abcdef";
const std::string kModel = TUMBLESIGHT_SHIPPED_MODEL;

class OneStep final : public RunSource {
 public:
  OneStep() {
    hal::dds::HelloSample hello{};
    hello.run_id = 1;
    hal::dds::set_target(hello, "near_shoemaker");
    log_.add(hello);
    hal::dds::AttitudeSample attitude{};
    attitude.run_id = 1;
    log_.add(attitude);
    log_.end();
  }
  const StepLog& log() const override { return log_; }
  const char* kind() const override { return "bus"; }
  std::string title() const override { return shown_title; }
  std::uint64_t first_frame() const override { return 0; }
  std::string ask(const std::string& request) const override {
    if (!answers) throw std::runtime_error("there is no run to ask");
    if (is_busy) throw RunIsBusy("send it again");
    asked = request;
    return said;
  }
  bool frame(std::uint64_t step, gnc::RangeImage& frame) const override {
    if (is_damaged) throw std::runtime_error("'run.mcap' is damaged");
    if (step != 0) return false;
    frame = {};
    frame.rays = 16;
    frame.fov_urad = 200'000;
    frame.ranges[3] = 0x1234;
    return true;
  }

  mutable std::string asked;
  std::string said = R"({"step":1})";
  bool answers = true, is_busy = false, is_damaged = false;
  std::string shown_title = "near_shoemaker";

 private:
  StepLog log_;
};

class ConsoleRequests : public testing::Test {
 protected:
  static Request get(const std::string& path, const std::string& query = "") {
    return {"GET", path, "token=" + kToken + (query.empty() ? "" : "&" + query), "127.0.0.1:7320", "", ""};
  }
  static Request post(const std::string& path, const std::string& body) {
    return {"POST", path, "token=" + kToken, "127.0.0.1:7320", "", body};
  }
  int status(const Request& request) const { return requests_.answer(request, kPort).status; }
  Json json(const Request& request) const { return Json::parse(requests_.answer(request, kPort).body); }

  OneStep run_;
  Requests requests_{run_, [](const std::string&) { return kModel; }, kToken};
};

TEST_F(ConsoleRequests, TheRunSaysWhatItIs) {
  const Json run = json(get("/api/run"));
  EXPECT_EQ(run["steps"], 1);
  EXPECT_EQ(run["target"], "near_shoemaker");
  EXPECT_GT(run["target_radius_m"].get<double>(), 1.0);
  EXPECT_EQ(run["fields"][0], "k");
  EXPECT_EQ(json(get("/api/steps", "from=0"))["rows"].size(), 1U);
  EXPECT_EQ(json(get("/api/step", "k=0"))["k"], 0);
  EXPECT_EQ(Json::parse(requests_.state_text())["steps"], 1);
}

TEST_F(ConsoleRequests, AFrameIsItsRangesInLittleEndian) {
  const std::string bytes = requests_.answer(get("/api/frame", "k=0"), kPort).body;
  ASSERT_EQ(bytes.size(), 8U + 2U * 16 * 16);
  EXPECT_EQ(bytes[0], 16);
  EXPECT_EQ(bytes[8 + 6], 0x34);
  EXPECT_EQ(bytes[8 + 7], 0x12);
  EXPECT_EQ(status(get("/api/frame", "k=1")), 404);
}

TEST_F(ConsoleRequests, DamageInARecordingIsAnAnswer) {
  run_.is_damaged = true;
  for (const char* path : {"/api/frame", "/api/depth"}) {
    const Answer answer = requests_.answer(get(path, "k=0"), kPort);
    EXPECT_EQ(answer.status, 500);
    EXPECT_EQ(answer.body, "'run.mcap' is damaged\n");
  }
}

// Latin-1, as a file system may have it.
TEST_F(ConsoleRequests, ANameThatIsNotUtf8IsShownAsFarAsItCanBe) {
  run_.shown_title = "f\xfcr.mcap";
  EXPECT_EQ(json(get("/api/run"))["title"], "f\xef\xbf\xbdr.mcap");
}

TEST_F(ConsoleRequests, FaultsHaveTheirLimits) {
  const Json faults = json(get("/api/faults"));
  EXPECT_EQ(faults["most_steps"], 1000);
  bool has_debris = false;
  for (const Json& fault : faults["faults"]) {
    if (fault["name"] != "debris") continue;
    has_debris = true;
    EXPECT_EQ(fault["least"], 0.1);
    EXPECT_EQ(fault["most"], 10.0);
    EXPECT_EQ(fault["unit"], "m");
  }
  EXPECT_TRUE(has_debris);
}

// What no run would take is wrong in the request, and its number is in the answer as it was given.
TEST_F(ConsoleRequests, WhatNoRunTakesIsRefusedAtTheDoor) {
  struct Wrong {
    std::string path, body, said;
  };
  const std::string zeros(2 * 3000, '0');
  for (const Wrong& wrong : {
           Wrong{"command", R"({"function":1.5,"bytes":""})", "not 1.5"},
           Wrong{"command", R"({"function":-1,"bytes":""})", "not -1"},
           Wrong{"command", R"({"function":128,"bytes":""})", "not 128"},
           Wrong{"command", R"({"function":4294967299,"bytes":"02"})", "not 4294967299"},
           Wrong{"command", R"({"function":18446744073709551616,"bytes":""})", "not 1.8446744073709552e+19"},
           Wrong{"command", R"({"function":3,"bytes":"0"})", "not '0'"},
           Wrong{"command", R"({"function":3,"bytes":"zz"})", "not 'zz'"},
           Wrong{"command", R"({"function":3,"bytes":")" + zeros + "\"}", "not 3000"},
           Wrong{"fault", R"({"fault":"nope","steps":3})", "no fault 'nope'"},
           Wrong{"fault", R"({"fault":"drop","steps":0})", "not 0"},
           Wrong{"fault", R"({"fault":"drop","steps":-1})", "not -1"},
           Wrong{"fault", R"({"fault":"drop","steps":1001})", "not 1001"},
           Wrong{"fault", R"({"fault":"drop","steps":2.5})", "not 2.5"},
           Wrong{"fault", R"({"fault":"drop","steps":1e300})", "not 1e+300"},
           Wrong{"fault", R"({"fault":"drop","steps":9223372036854775808})", "not 9223372036854775808"},
           Wrong{"fault", R"({"fault":"drop","steps":3,"strength":7})", "leave out 7"},
           Wrong{"fault", R"({"fault":"debris","steps":3})", "needs a strength"},
           Wrong{"fault", R"({"fault":"debris","strength":-1,"steps":3})", "not -1"},
           Wrong{"fault", R"({"fault":"debris","strength":1e308,"steps":3})", "not 1e+308"},
       }) {
    Request request = post("/api/" + wrong.path, wrong.body);
    const Answer answer = requests_.answer(request, kPort);
    EXPECT_EQ(answer.status, 400) << wrong.body.substr(0, 60);
    EXPECT_NE(answer.body.find(wrong.said), std::string::npos) << answer.body;
  }
  EXPECT_EQ(run_.asked, "");
}

TEST_F(ConsoleRequests, NumbersOfARequestAreNotChanged) {
  Request request = post("/api/fault", R"({"fault":"debris","strength":1.5,"steps":1000})");
  EXPECT_EQ(status(request), 200);
  EXPECT_EQ(Json::parse(run_.asked)["steps"], 1000);
  EXPECT_EQ(Json::parse(run_.asked)["strength"], 1.5);
}

// Deep nesting would take more stack than a thread of the server has.
TEST_F(ConsoleRequests, ANumberThatIsNoneIsRefused) {
  const std::string nested = std::string(2000, '[') + std::string(2000, ']');
  for (const std::string& wrong : {nested, std::string("\"5\""), std::string("null"), std::string("true")}) {
    Request request = post("/api/fault", R"({"fault":"drop","steps":)" + wrong + "}");
    EXPECT_EQ(status(request), 400) << wrong;
    request.body = R"({"fault":"debris","steps":1,"strength":)" + wrong + "}";
    EXPECT_EQ(status(request), 400) << wrong;
    request.path = "/api/command";
    request.body = R"({"bytes":"","function":)" + wrong + "}";
    EXPECT_EQ(status(request), 400) << wrong;
  }
  EXPECT_EQ(run_.asked, "");
}

TEST_F(ConsoleRequests, TheMeshIsThatOfTheModelImage) {
  const std::string bytes = requests_.answer(get("/api/mesh"), kPort).body;
  std::uint32_t vertices = 0, triangles = 0;
  std::memcpy(&vertices, bytes.data(), 4);
  std::memcpy(&triangles, bytes.data() + 4, 4);
  EXPECT_GT(triangles, 100U);
  EXPECT_EQ(bytes.size(), 8 + 12 * std::size_t{vertices} + 6 * std::size_t{triangles});
  // Of too few returns the network sees nothing.
  EXPECT_EQ(status(get("/api/depth", "k=0")), 404);
}

TEST_F(ConsoleRequests, AnUnknownTargetHasNoMeshAndSaysHowToGiveOne) {
  const Requests without(
      run_, [](const std::string&) { return ""; }, kToken);
  const Answer answer = without.answer(get("/api/mesh"), kPort);
  EXPECT_EQ(answer.status, 404);
  EXPECT_NE(answer.body.find("--model"), std::string::npos);
  EXPECT_TRUE(Json::parse(without.answer(get("/api/run"), kPort).body)["target_radius_m"].is_null());
  const Requests damaged(
      run_, [](const std::string&) { return "/none.tsm"; }, kToken);
  EXPECT_EQ(damaged.answer(get("/api/mesh"), kPort).status, 404);
}

TEST_F(ConsoleRequests, WithoutTheTokenThereIsNoData) {
  for (const char* path : {"/", "/api/run", "/api/steps", "/api/step", "/api/frame", "/api/depth",
                           "/api/mesh", "/ws", "/none"}) {
    for (const char* query :
         {"", "token=", "token=0123456789abcdee", "token=0123456789abcdef0", "x=0123456789abcdef"}) {
      Request request = get(path);
      request.query = query;
      EXPECT_EQ(status(request), 403) << path << " " << query;
    }
  }
  Request script = get("/main.js");
  script.query = "";
  EXPECT_EQ(status(script), 200);
}

TEST_F(ConsoleRequests, AnotherHostOrOriginGetsNothing) {
  for (const char* host :
       {"", "evil:7320", "127.0.0.1", "127.0.0.1:7321", "localhost:80", "127.0.0.1.evil:7320"}) {
    Request request = get("/");
    request.host = host;
    EXPECT_EQ(status(request), 403) << host;
  }
  for (const char* origin : {"null", "http://evil", "http://127.0.0.1:7321", "https://127.0.0.1:7320"}) {
    Request request = get("/api/run");
    request.origin = origin;
    EXPECT_EQ(status(request), 403) << origin;
  }
  Request request = get("/api/run");
  request.origin = "http://127.0.0.1:7320";
  EXPECT_EQ(status(request), 200);
  request.host = "localhost:7320";
  request.origin = "http://localhost:7320";
  EXPECT_EQ(status(request), 200);
}

TEST_F(ConsoleRequests, WrongOnesSayWhatIsWrong) {
  for (const char* query : {"", "k=", "k=-1", "k=x", "k=1x", "k=99999999999999999999", "kk=1"}) {
    const Answer answer = requests_.answer(get("/api/step", query), kPort);
    EXPECT_EQ(answer.status, 400) << query;
    EXPECT_NE(answer.body.find("k=NUMBER"), std::string::npos);
  }
  EXPECT_EQ(status(get("/api/step", "k=18446744073709551615")), 404);
  EXPECT_EQ(status(get("/api/steps", "from=")), 400);
  EXPECT_EQ(status(get("/../main.cpp")), 404);
  Request request = get("/api/run");
  request.method = "PUT";
  EXPECT_EQ(status(request), 405);
}

TEST_F(ConsoleRequests, ATelecommandIsCheckedAndSentAsBytes) {
  EXPECT_EQ(
      requests_.answer(post("/api/command", R"({"name":"SET_MODE","arguments":{"mode":"2"}})"), kPort).body,
      R"({"step":1})");
  EXPECT_EQ(run_.asked, R"({"function":3,"arguments":"02"})");
  EXPECT_EQ(status(post("/api/command", R"({"function":99,"bytes":"ff"})")), 200);
  EXPECT_EQ(run_.asked, R"({"function":99,"arguments":"ff"})");
  EXPECT_EQ(status(post("/api/fault", R"({"fault":"freeze","steps":5})")), 200);
  EXPECT_EQ(run_.asked, R"({"fault":"freeze","steps":5})");
  const Answer wrong =
      requests_.answer(post("/api/command", R"({"name":"SET_MODE","arguments":{"mode":"9"}})"), kPort);
  EXPECT_EQ(wrong.status, 400);
  EXPECT_EQ(wrong.body, "SET_MODE: mode '9' must be a whole number from 1 to 3\n");
  for (const char* body : {"", "x", "[]", "{}", R"({"name":3,"arguments":{}})", R"({"name":"NOOP"})"})
    EXPECT_EQ(status(post("/api/command", body)), 400) << body;
  EXPECT_EQ(status(post("/api/run", "{}")), 405);
  run_.answers = false;
  EXPECT_EQ(status(post("/api/fault", R"({"fault":"freeze","steps":5})")), 409);
  Request foreign = post("/api/command", R"({"name":"NOOP","arguments":{}})");
  foreign.origin = "http://evil";
  EXPECT_EQ(status(foreign), 403);
}

TEST_F(ConsoleRequests, WhatTheRunRefusesIsNoSuccess) {
  run_.said = R"({"error":"a step takes at most 16 telecommands: send it again"})";
  Request request = post("/api/command", R"({"name":"NOOP","arguments":{}})");
  const Answer answer = requests_.answer(request, kPort);
  EXPECT_EQ(answer.status, 409);
  EXPECT_EQ(answer.body, "a step takes at most 16 telecommands: send it again\n");
}

// It comes back to a page or a terminal.
TEST_F(ConsoleRequests, ANameThatIsNotKnownIsShownShortenedAndWithoutControlCharacters) {
  for (const std::string& unknown : {std::string(3000, 'a'), std::string("\\u001b[31m")}) {
    Request request = post("/api/command", R"({"name":")" + unknown + R"(","arguments":{}})");
    const Answer command = requests_.answer(request, kPort);
    request.path = "/api/fault";
    request.body = R"({"fault":")" + unknown + R"(","steps":1})";
    const Answer fault = requests_.answer(request, kPort);
    for (const Answer& answer : {command, fault}) {
      EXPECT_EQ(answer.status, 400);
      EXPECT_LT(answer.body.size(), 1000U);
      EXPECT_EQ(answer.body.find('\x1b'), std::string::npos) << answer.body;
    }
  }
}

TEST_F(ConsoleRequests, ARunThatIsBusyIsAskedAgainLater) {
  run_.is_busy = true;
  Request request = post("/api/command", R"({"name":"NOOP","arguments":{}})");
  const Answer answer = requests_.answer(request, kPort);
  EXPECT_EQ(answer.status, 503);
  EXPECT_EQ(answer.body, "send it again\n");
}

TEST_F(ConsoleRequests, EveryPathHasItsMethods) {
  for (const char* path :
       {"/", "/main.js", "/api/run", "/api/steps", "/api/step", "/api/frame", "/api/depth", "/api/mesh",
        "/api/commands", "/api/faults", "/api/command", "/api/fault", "/none", "/api", "/api/run/"}) {
    const bool is_sent_to = std::string(path) == "/api/command" || std::string(path) == "/api/fault";
    for (const char* method : {"POST", "PUT", "DELETE", "PATCH", "OPTIONS", "get", ""}) {
      Request request = get(path, "k=0&from=0");
      request.method = method;
      request.body = "{}";
      const Answer answer = requests_.answer(request, kPort);
      if (is_sent_to && request.method == "POST") {
        EXPECT_EQ(answer.status, 400) << path;
      } else if (answer.status != 404) {
        EXPECT_EQ(answer.status, 405) << method << " " << path;
        EXPECT_EQ(answer.allow, is_sent_to ? "POST" : "GET, HEAD") << path;
      }
    }
    if (is_sent_to) {
      EXPECT_EQ(status(get(path)), 405) << path;
    }
  }
  EXPECT_EQ(status(get("/none")), 404);
}

TEST_F(ConsoleRequests, ABodyThatIsDeepOrLargeIsRefused) {
  const auto answer = [this](const std::string& body) {
    Request request = post("/api/command", body);
    return requests_.answer(request, kPort);
  };
  EXPECT_EQ(answer(std::string(8'000, '[') + std::string(8'000, ']')).body,
            "its JSON is nested more than 8 deep\n");
  EXPECT_EQ(answer(std::string(16'000, '[')).status, 400);
  EXPECT_EQ(answer("{\"arguments\":" + std::string(8'000, '[') + std::string(8'000, ']') + "}").status, 400);
  EXPECT_EQ(answer(std::string(Requests::kMostBody + 1, ' ')).status, 413);
  EXPECT_EQ(answer("[" + std::string(100, ' ') + "]").status, 400);
  EXPECT_EQ(run_.asked, "");
}

TEST_F(ConsoleRequests, AFieldOrAnArgumentThatIsNotKnownIsRefusedByName) {
  const auto refusal = [this](const std::string& path, const std::string& body) {
    Request request = post(path, body);
    const Answer answer = requests_.answer(request, kPort);
    EXPECT_EQ(answer.status, 400) << body;
    return answer.body;
  };
  EXPECT_EQ(refusal("/api/command", R"({"name":"NOOP","arguments":{"mode":"2"}})"),
            "NOOP: there is no argument 'mode'; it takes none\n");
  EXPECT_EQ(refusal("/api/command", R"({"name":"SET_MODE","arguments":{"mode":"2","Mode":"3"}})"),
            "SET_MODE: there is no argument 'Mode'; it takes mode\n");
  EXPECT_NE(refusal("/api/command", R"({"name":"NOOP","arguments":{},"step":4})").find("'step'"),
            std::string::npos);
  EXPECT_NE(refusal("/api/command", R"({"function":1,"bytes":"","arguments":{}})").find("'arguments'"),
            std::string::npos);
  EXPECT_NE(refusal("/api/fault", R"({"fault":"drop","steps":1,"strenght":2})").find("'strenght'"),
            std::string::npos);
  EXPECT_NE(refusal("/api/command", R"({"name":"NOOP","arguments":[]})").find("object"), std::string::npos);
  EXPECT_EQ(run_.asked, "");
}

TEST_F(ConsoleRequests, ThePageComesWithItsFilesAndLibraries) {
  const Answer page = requests_.answer(get("/"), kPort);
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.type, "text/html; charset=utf-8");
  std::size_t files = 0;
  for (const char* const mark : {"src=\"", "href=\""}) {
    for (std::size_t at = page.body.find(mark); at != std::string::npos; at = page.body.find(mark, at + 1)) {
      const std::size_t begin = at + std::strlen(mark);
      std::string file = page.body.substr(begin, page.body.find('"', begin) - begin);
      if (file.rfind("data:", 0) == 0) continue;
      EXPECT_EQ(file.find("//"), std::string::npos) << file << ": nothing comes from another host";
      if (file.front() != '/') file = "/" + file;
      EXPECT_EQ(status(get(file)), 200) << file;
      ++files;
    }
  }
  EXPECT_GT(files, 3U);
}

}  // namespace
}  // namespace tumblesight::sim
