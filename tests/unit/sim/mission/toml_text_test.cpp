// TOML of a user's own: nested values and keys are refused before they are parsed, in time proportional to
// the text, and what is not nested is not.
#include "sim/mission/toml_text.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "tests/support/hostile_files.hpp"

namespace tumblesight::sim {
namespace {

std::string repeated(const std::string& part, int times) {
  std::string text;
  for (int i = 0; i < times; ++i) text += part;
  return text;
}

std::string refusal_of(const std::string& text) {
  return outcome_of([&] { (void)parse_toml(text, "a.toml"); }).message;
}

TEST(TomlText, ThatIsNestedDeeplyIsRefusedWithItsLine) {
  constexpr int kDeep = 100'000;
  const std::pair<std::string, const char*> deep[] = {
      {"\na = " + std::string(kDeep, '['), "a.toml, line 2: lists and tables are nested more than 16 deep"},
      {"a = " + std::string(kDeep, '[') + std::string(kDeep, ']'), "line 1: lists and tables are nested"},
      {"a = " + repeated("{a = ", kDeep), "line 1: lists and tables are nested"},
      {repeated("a.", kDeep) + "a = 1", "line 1: a key has more than 16 parts"},
      {repeated("\"a\" . ", kDeep) + "a = 1", "line 1: a key has more than 16 parts"},
      {"\n\n[" + repeated("a.", kDeep) + "a]\n", "line 3: a key has more than 16 parts"},
      {"a = [\"\"\"\"x\"\"\"\", {" + repeated("a.", kDeep) + "a = 1}]",
       "line 1: a key has more than 16 parts"},
      {"a = '''x''''\nb = {" + repeated("a.", kDeep) + "a = 1}", "line 2: a key has more than 16 parts"},
  };
  for (const auto& [text, message] : deep) {
    const std::string refusal = refusal_of(text);
    EXPECT_NE(refusal.find(message), std::string::npos) << text.substr(0, 40) << ": " << refusal;
    EXPECT_LT(refusal.size(), 200U);
  }
}

TEST(TomlText, ThatIsNotNestedIsParsed) {
  const std::string texts[] = {
      "# " + std::string(200, '.') + std::string(200, '['),
      "a = \"" + std::string(200, '.') + std::string(200, '[') + "\\\"[\"",
      "a = '" + std::string(200, '[') + "'",
      "a = \"\"\"\n" + std::string(200, '[') + "\n\"\"\"\n",
      "a = [" + repeated("1.5, ", 10'000) + "]",
      repeated("[[run]]\nx = [[1.0], [2.0]]\n", 10'000),
      "a.b.c.d = { e.f = [[[{g = 1}]]] }",
  };
  for (const std::string& text : texts) EXPECT_EQ(refusal_of(text), "") << text.substr(0, 40);
}

TEST(TomlText, ThatIsNoneIsToldApart) {
  EXPECT_EQ(refusal_of(std::string("solid\0craft", 11)),
            "a.toml: it is no text, as it has bytes of value 0; is it another file?");
  EXPECT_NE(refusal_of("a = 1\nname = craft\n").find("line 2: "), std::string::npos);
  EXPECT_NE(refusal_of("a = 1\nname = craft\n").find("; a text stands in quotes: name = \"craft\""),
            std::string::npos);
}

// The bound is a hundred times what they need.
TEST(TomlText, OfTheLargestSizeIsParsedOrRefusedInBoundedTime) {
  constexpr int kMost = 100'000;
  constexpr double kMost_s = 5.0;
  std::string keys;
  for (int i = 0; i < kMost / 2; ++i) keys += "k" + std::to_string(i) + " = 1\n";
  const std::string texts[] = {keys,
                               repeated("[[a]]\n", kMost),
                               repeated("a = 1\n", kMost),
                               "a = \"" + std::string(900'000, 'x'),
                               "a = " + std::string(900'000, '1'),
                               std::string(900'000, '\n'),
                               std::string(900'000, '\0'),
                               std::string(900'000, '"'),
                               repeated("a.", 15) + std::string(900'000, 'a') + " = 1",
                               "a = [" + repeated("{a = 1},", kMost) + "]",
                               "a = [" + repeated("[],", kMost) + "]"};
  for (const std::string& text : texts) {
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = outcome_of([&] { (void)parse_toml(text, "a.toml"); });
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    EXPECT_EQ(outcome.signal, 0) << text.substr(0, 40);
    EXPECT_LT(took.count(), kMost_s) << text.substr(0, 40);
    EXPECT_LT(outcome.message.size(), 300U) << outcome.message.substr(0, 400);
  }
}

}  // namespace
}  // namespace tumblesight::sim
