#include "hal/dds/idl/hello.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace tumblesight::hal::dds {
namespace {

HelloSample hello(const char* target, std::uint32_t model_crc32) {
  HelloSample sample{};
  sample.icd_hash = 7;
  sample.model_crc32 = model_crc32;
  set_target(sample, target);
  return sample;
}

// Verifies TS-IFC-060, TS-IFC-065.
TEST(Hello, FitsOneWithTheSameInterfaceTargetAndModelImage) {
  const HelloSample ours = hello("near", 5);
  EXPECT_EQ(fit(ours, hello("near", 5)), HelloFit::kFits);
  EXPECT_EQ(fit(ours, hello("near", 6)), HelloFit::kOtherModel);
  EXPECT_EQ(fit(ours, hello("nea", 5)), HelloFit::kOtherTarget);
  EXPECT_EQ(fit(ours, hello("nearer", 6)), HelloFit::kOtherTarget);
  HelloSample other = hello("near", 5);
  other.icd_hash = 8;
  EXPECT_EQ(fit(ours, other), HelloFit::kOtherInterface);
}

// A flight program without an image is in SAFE, and the run says so.
TEST(Hello, ComparesModelImagesThatAreThere) {
  EXPECT_EQ(fit(hello("near", 0), hello("near", 6)), HelloFit::kFits);
  EXPECT_EQ(fit(hello("near", 5), hello("near", 0)), HelloFit::kFits);
}

TEST(Hello, TargetIsCutOffAndReadableWhateverItsBytes) {
  EXPECT_STREQ(target_of(hello(std::string(40, 'a').c_str(), 0)).text, std::string(31, 'a').c_str());
  HelloSample forged = hello("near\n\x1b[2J", 0);
  EXPECT_STREQ(target_of(forged).text, "near???2?");
  std::memset(forged.target, 'x', sizeof forged.target);
  EXPECT_STREQ(target_of(forged).text, std::string(32, 'x').c_str());
}

}  // namespace
}  // namespace tumblesight::hal::dds
