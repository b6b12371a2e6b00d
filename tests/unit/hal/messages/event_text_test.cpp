#include "hal/messages/event_text.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace tumblesight::hal {
namespace {

TEST(EventText, IsAnotherOneForEachEvent) {
  std::set<std::string> texts;
  for (const EventRule& rule : kEventRules) texts.insert(text_of(rule.id));
  EXPECT_EQ(texts.size(), kEventRules.size());
  EXPECT_EQ(texts.count("unknown"), 0U);
  EXPECT_STREQ(text_of(static_cast<EventId>(999)), "unknown");
}

}  // namespace
}  // namespace tumblesight::hal
