// JSON from outside: depth and size are limited before a value is built, so that no text exhausts the stack.
#include "sim/json/json_text.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace tumblesight::sim {
namespace {

std::string repeated(const std::string& part, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += part;
  return text;
}

std::string why(const std::string& text, const JsonLimits& limits = {}) {
  try {
    parse_json(text, limits);
    parse_json<nlohmann::ordered_json>(text, limits);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

constexpr char kTooDeep[] = "its JSON is nested more than 32 deep";

TEST(JsonText, TakesTheDepthOfTheLimitAndNoMore) {
  EXPECT_EQ(why(repeated("[", 32) + repeated("]", 32)), "");
  EXPECT_EQ(why(repeated("[", 33) + repeated("]", 33)), kTooDeep);
  EXPECT_EQ(why(repeated("{\"a\":", 32) + "1" + repeated("}", 32)), "");
  EXPECT_EQ(why(repeated("{\"a\":", 33) + "1" + repeated("}", 33)), kTooDeep);
  EXPECT_EQ(why("[[[]]]", {2}), "its JSON is nested more than 2 deep");
}

TEST(JsonText, RefusesDeepNestingOfEveryKind) {
  for (const std::size_t depth : {std::size_t{1'000}, std::size_t{100'000}, std::size_t{2'000'000}}) {
    EXPECT_EQ(why(repeated("[", depth) + repeated("]", depth)), kTooDeep) << depth;
    EXPECT_EQ(why(repeated("[", depth)), kTooDeep) << depth << ", cut";
    EXPECT_EQ(why(repeated("{\"a\":", depth) + "1" + repeated("}", depth)), kTooDeep) << depth;
    EXPECT_EQ(why(repeated("[{\"a\":", depth) + "1" + repeated("}]", depth)), kTooDeep) << depth;
    EXPECT_EQ(why("{\"a\": [1, 2], \"b\": " + repeated("[", depth) + repeated("]", depth) + "}"), kTooDeep)
        << depth;
    EXPECT_EQ(why("[\"a \\\" \", " + repeated("[\"]\",", depth) + "1" + repeated("]", depth) + "]"), kTooDeep)
        << depth;
  }
}

TEST(JsonText, DoesNotCountBracketsInStrings) {
  const std::string brackets = repeated("[{", 100'000);
  EXPECT_EQ(parse_json("[\"" + brackets + "\"]").at(0), brackets);
  EXPECT_EQ(why("{\"" + brackets + "\": \"\\\"" + brackets + "\\\\\"}"), "");
}

TEST(JsonText, TakesMuchThatIsNotDeep) {
  EXPECT_EQ(parse_json("[" + repeated("[],", 100'000) + "{}]").size(), 100'001u);
}

TEST(JsonText, SaysWhereTheTextIsDamaged) {
  EXPECT_EQ(why("{\"a\": 1"), "its JSON is damaged at byte 8");
  EXPECT_EQ(why(""), "its JSON is damaged at byte 1");
  EXPECT_EQ(why("]]]]"), "its JSON is damaged at byte 1");
  EXPECT_EQ(why("[1e999]"), "its JSON has a number that is out of range");
}

TEST(JsonText, RefusesATextThatIsTooLarge) {
  EXPECT_EQ(why("[1, 2]", {32, 5}), "its JSON has 6 bytes; at most 5");
  EXPECT_EQ(why("[1, 2]", {32, 6}), "");
}

}  // namespace
}  // namespace tumblesight::sim
