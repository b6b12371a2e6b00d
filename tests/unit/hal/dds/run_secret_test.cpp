#include "hal/dds/idl/run_secret.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tumblesight::hal::dds {
namespace {

// Verifies TS-SIL-095.
TEST(RunSecret, IsAnotherOneForEachRun) {
  RunSecret a;
  RunSecret b;
  ASSERT_TRUE(make_run_secret(a));
  ASSERT_TRUE(make_run_secret(b));
  EXPECT_NE(a.run_id, 0U);
  EXPECT_NE(a.run_id, b.run_id);
  EXPECT_STRNE(a.partition, b.partition);
  EXPECT_EQ(std::string(a.partition).size(), RunSecret::kPartitionDigits);
}

TEST(RunSecret, IsReadAsItWasWritten) {
  RunSecret secret;
  ASSERT_TRUE(make_run_secret(secret));
  RunSecret read;
  ASSERT_TRUE(read_run_secret(to_text(secret).text, read));
  EXPECT_EQ(read.run_id, secret.run_id);
  EXPECT_STREQ(read.partition, secret.partition);
  RunSecret largest = secret;
  largest.run_id = UINT32_MAX;
  ASSERT_TRUE(read_run_secret(to_text(largest).text, read));
  EXPECT_EQ(read.run_id, UINT32_MAX);
}

TEST(RunSecret, OtherTextIsRefused) {
  const std::string digits(RunSecret::kPartitionDigits, 'a');
  for (const std::string& text :
       {std::string(), std::string("7"), std::string("7:"), ":" + digits, "-7:" + digits, "7:" + digits + "a",
        "7:" + digits.substr(1), "7:*" + digits.substr(1), "4294967296:" + digits, "7 :" + digits}) {
    RunSecret secret;
    EXPECT_FALSE(read_run_secret(text.c_str(), secret)) << text;
    EXPECT_EQ(secret.run_id, 0U);
  }
}

}  // namespace
}  // namespace tumblesight::hal::dds
