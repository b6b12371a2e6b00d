// What a client of the Foxglove WebSocket protocol gets, and what it may send.
#include "sim/console/foxglove_session.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "sim/console/requests.hpp"
#include "tests/support/growing_run.hpp"

namespace tumblesight::sim {
namespace {

using test::GrowingRun;
using test::kPeriod_ns;
using Outgoing = FoxgloveSession::Outgoing;
constexpr std::uint32_t kPoints = 1, kTransforms = 2, kLog = 3, kFigures = 4;

std::uint64_t number_at(const Outgoing& message, std::size_t at, std::size_t size) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < size; ++i)
    number |= std::uint64_t{static_cast<std::uint8_t>(message.bytes[at + i])} << (8 * i);
  return number;
}
Json payload_of(const Outgoing& message) {
  EXPECT_TRUE(message.is_binary);
  EXPECT_EQ(message.bytes[0], 1);
  return Json::parse(message.bytes.substr(13));
}
std::string subscription(std::uint32_t id, std::uint32_t channel) {
  return Json{{"op", "subscribe"}, {"subscriptions", Json::array({{{"id", id}, {"channelId", channel}}})}}
      .dump();
}

class Foxglove : public testing::Test {
 protected:
  Foxglove() { session_.begin(); }
  void subscribe(std::uint32_t id, std::uint32_t channel) {
    EXPECT_TRUE(session_.receive(subscription(id, channel)).empty());
  }
  // The message of the warning, "" without one.
  std::string warning_of(const std::string& text) {
    const std::vector<Outgoing> answers = session_.receive(text);
    if (answers.empty()) return {};
    EXPECT_EQ(answers.size(), 1U);
    EXPECT_FALSE(answers[0].is_binary);
    const Json status = Json::parse(answers[0].bytes);
    EXPECT_EQ(status["op"], "status");
    EXPECT_EQ(status["level"], 1);
    return status["message"].get<std::string>();
  }

  GrowingRun run_;
  FoxgloveSession session_{run_};
};

TEST_F(Foxglove, BeginsWithTheServerAndItsChannels) {
  const std::vector<Outgoing> first = session_.begin();
  ASSERT_EQ(first.size(), 2U);
  EXPECT_EQ(first[0].bytes,
            R"({"op":"serverInfo","name":"tumblesight console","capabilities":[],"sessionId":"00000007"})");
  const Json advertised = Json::parse(first[1].bytes);
  EXPECT_EQ(advertised["op"], "advertise");
  std::set<std::string> topics;
  for (const Json& channel : advertised["channels"]) {
    topics.insert(channel["topic"].get<std::string>());
    EXPECT_EQ(channel["encoding"], "json");
    EXPECT_EQ(channel["schemaEncoding"], "jsonschema");
    EXPECT_TRUE(Json::parse(channel["schema"].get<std::string>()).is_object());
  }
  EXPECT_EQ(topics, (std::set<std::string>{"/lidar/points", "/tf", "/events", "/figures"}));
}

TEST_F(Foxglove, ADeepMessageIsRefused) {
  for (const std::size_t depth : {std::size_t{1'000}, std::size_t{30'000}}) {
    std::string objects;
    for (std::size_t i = 0; i < depth && objects.size() < 60'000; ++i) objects += "{\"op\":";
    for (const std::string& message :
         {std::string(depth, '[') + std::string(depth, ']'), std::string(depth, '['), objects,
          R"({"op":"subscribe","subscriptions":)" + std::string(depth, '[') + std::string(depth, ']') + "}"})
      EXPECT_EQ(warning_of(message), "the message is not taken: its JSON is nested more than 16 deep");
  }
}

TEST_F(Foxglove, AMessageHasItsSubscriptionAndTheTimeOfItsStep) {
  run_.add_step();
  EXPECT_TRUE(session_.poll().empty());
  subscribe(0xA1B2C3D4, kFigures);
  const std::vector<Outgoing> news = session_.poll();
  ASSERT_EQ(news.size(), 1U);
  EXPECT_EQ(number_at(news[0], 1, 4), 0xA1B2C3D4);
  EXPECT_EQ(number_at(news[0], 5, 8), std::uint64_t{kPeriod_ns});
  EXPECT_EQ(payload_of(news[0])["true_range_m"], 31.0);
  EXPECT_TRUE(session_.poll().empty());
}

TEST_F(Foxglove, EachChannelHasItsOwnOfAStep) {
  for (const std::uint32_t channel : {kPoints, kTransforms, kLog, kFigures}) subscribe(10 + channel, channel);
  run_.add_step(2);
  std::map<std::uint64_t, std::vector<Json>> by_id;
  for (const Outgoing& message : session_.poll())
    by_id[number_at(message, 1, 4)].push_back(payload_of(message));
  ASSERT_EQ(by_id.size(), 4U);
  EXPECT_EQ(by_id[10 + kPoints].at(0)["frame_id"], "lrf");
  EXPECT_EQ(by_id[10 + kTransforms].at(0)["transforms"][0]["child_frame_id"], "target_true");
  EXPECT_EQ(by_id[10 + kLog].size(), 2U);
  EXPECT_EQ(by_id[10 + kFigures].at(0)["valid"], true);
}

TEST_F(Foxglove, WhatIsNotKnownOfTheTruthIsLeftOut) {
  subscribe(1, kTransforms);
  subscribe(2, kFigures);
  run_.add_step(0, std::nanf(""));
  const std::vector<Outgoing> news = session_.poll();
  ASSERT_EQ(news.size(), 2U);
  EXPECT_EQ(payload_of(news[0])["transforms"][0]["child_frame_id"], "target_network");
  EXPECT_FALSE(payload_of(news[1]).contains("true_range_m"));
  EXPECT_EQ(payload_of(news[1])["network_error_deg"], 0.0);
}

TEST_F(Foxglove, ALateClientBeginsWithTheNewestStep) {
  for (int i = 0; i < 5; ++i) run_.add_step();
  subscribe(1, kFigures);
  ASSERT_EQ(session_.poll().size(), 1U);
  subscribe(2, kTransforms);
  const std::vector<Outgoing> news = session_.poll();
  ASSERT_EQ(news.size(), 1U);
  EXPECT_EQ(number_at(news[0], 1, 4), 2U);
  EXPECT_EQ(number_at(news[0], 5, 8), 5U * std::uint64_t{kPeriod_ns});
}

TEST_F(Foxglove, ASlowClientGetsAllFiguresInPartsAndTheNewestPointsAlone) {
  subscribe(1, kFigures);
  subscribe(2, kPoints);
  constexpr std::uint64_t kSteps = 3 * FoxgloveSession::kStepsPerPoll / 2;
  for (std::uint64_t i = 0; i < kSteps; ++i) run_.add_step();
  EXPECT_EQ(session_.poll().size(), FoxgloveSession::kStepsPerPoll);
  const std::vector<Outgoing> rest = session_.poll();
  ASSERT_EQ(rest.size(), kSteps - FoxgloveSession::kStepsPerPoll + 1);
  std::size_t clouds = 0;
  for (const Outgoing& message : rest) clouds += number_at(message, 1, 4) == 2;
  EXPECT_EQ(clouds, 1U);
  EXPECT_EQ(number_at(rest.back(), 5, 8), kSteps * std::uint64_t{kPeriod_ns});
  EXPECT_TRUE(session_.poll().empty());
}

TEST_F(Foxglove, AFrameThatComesAfterItsStepIsWaitedFor) {
  subscribe(1, kPoints);
  run_.has_frames = false;
  run_.add_step();
  EXPECT_TRUE(session_.poll().empty());
  run_.has_frames = true;
  EXPECT_EQ(session_.poll().size(), 1U);
  EXPECT_TRUE(session_.poll().empty());
}

TEST_F(Foxglove, AFrameThatCannotBeReadIsAnError) {
  subscribe(1, kPoints);
  run_.is_damaged = true;
  run_.add_step();
  const std::vector<Outgoing> news = session_.poll();
  ASSERT_EQ(news.size(), 1U);
  EXPECT_EQ(Json::parse(news[0].bytes)["level"], 2);
  EXPECT_TRUE(session_.poll().empty());
}

TEST_F(Foxglove, ANewRunIsANewSessionWithTheSameSubscriptions) {
  subscribe(1, kFigures);
  run_.add_step();
  run_.add_step();
  session_.poll();
  run_.begin(8);
  run_.add_step();
  const std::vector<Outgoing> news = session_.poll();
  ASSERT_EQ(news.size(), 3U);
  EXPECT_EQ(Json::parse(news[0].bytes)["sessionId"], "00000008");
  EXPECT_EQ(Json::parse(news[1].bytes)["op"], "advertise");
  EXPECT_EQ(number_at(news[2], 1, 4), 1U);
}

TEST_F(Foxglove, TimesBeforeZeroBeginAtZero) {
  GrowingRun run(-3 * kPeriod_ns);
  run.add_step();
  run.add_step();
  FoxgloveSession session(run);
  session.begin();
  EXPECT_TRUE(session.receive(subscription(1, kFigures)).empty());
  const std::vector<Outgoing> news = session.poll();
  ASSERT_EQ(news.size(), 1U);
  EXPECT_EQ(number_at(news[0], 5, 8), std::uint64_t{kPeriod_ns});
}

TEST_F(Foxglove, AfterUnsubscribingNothingComesAndTheIdIsFree) {
  subscribe(1, kFigures);
  EXPECT_EQ(warning_of(R"({"op":"unsubscribe","subscriptionIds":[1]})"), "");
  run_.add_step();
  EXPECT_TRUE(session_.poll().empty());
  EXPECT_NE(warning_of(R"({"op":"unsubscribe","subscriptionIds":[1]})"), "");
  subscribe(1, kTransforms);
}

TEST_F(Foxglove, WrongMessagesGetAWarningAndChangeNothing) {
  for (const char* text :
       {"", "x", "[]", "{}", R"({"op":1})", R"({"op":"getParameters"})", "\x01\xFF\xFE",
        R"({"op":"subscribe"})", R"({"op":"subscribe","subscriptions":{}})",
        R"({"op":"subscribe","subscriptions":[1]})", R"({"op":"subscribe","subscriptions":[{"id":1}]})",
        R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1.5,"channelId":1}]})",
        R"({"op":"subscribe","subscriptions":[{"id":"1","channelId":1}]})",
        R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":1}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":0}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":5}]})", R"({"op":"unsubscribe"})",
        R"({"op":"unsubscribe","subscriptionIds":[{}]})"})
    EXPECT_NE(warning_of(text), "") << text;
  run_.add_step();
  EXPECT_TRUE(session_.poll().empty());
}

TEST_F(Foxglove, AChannelAndAnIdAreSubscribedOnce) {
  subscribe(1, kFigures);
  EXPECT_EQ(warning_of(subscription(2, kFigures)), "channel 4 has already subscription 1");
  EXPECT_EQ(warning_of(subscription(1, kLog)), "there is already a subscription 1");
}

TEST_F(Foxglove, TooLongAListOrMessageIsRefused) {
  Json many{{"op", "subscribe"}, {"subscriptions", Json::array()}};
  for (std::size_t i = 0; i <= FoxgloveSession::kMostSubscriptions; ++i)
    many["subscriptions"].push_back({{"id", i}, {"channelId", 1 + i % 4}});
  EXPECT_NE(warning_of(many.dump()).find("at most 64"), std::string::npos);
  EXPECT_NE(warning_of(std::string(FoxgloveSession::kMostBytes + 1, '[')), "");
  EXPECT_NE(warning_of(std::string(FoxgloveSession::kMostBytes, '[')), "");
}

TEST_F(Foxglove, AnAppNeedsHostAndTokenAndMayHaveAnyOrigin) {
  const Requests requests(
      run_, [](const std::string&) { return ""; }, "abc");
  Request request{"GET", "/", "token=abc", "127.0.0.1:7320", "https://app.foxglove.dev", ""};
  EXPECT_EQ(requests.refusal_of_foxglove(request, 7320), "");
  EXPECT_NE(requests.refusal_of(request, 7320), "");
  request.host = "evil:7320";
  EXPECT_NE(requests.refusal_of_foxglove(request, 7320), "");
  request.host = "localhost:7320";
  request.query = "token=abd";
  EXPECT_NE(requests.refusal_of_foxglove(request, 7320), "");
}

}  // namespace
}  // namespace tumblesight::sim
