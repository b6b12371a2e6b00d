#include "hal/dds/idl/hello.hpp"

#include <cstring>

namespace tumblesight::hal::dds {
namespace {

bool can_be_in_a_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
}

}  // namespace

void set_target(HelloSample& hello, const char* target) {
  std::memset(hello.target, 0, sizeof hello.target);
  std::memcpy(hello.target, target, strnlen(target, sizeof hello.target - 1));
}

TargetText target_of(const HelloSample& hello) {
  TargetText result{};
  std::memcpy(result.text, hello.target, sizeof hello.target);
  for (char* c = result.text; *c != '\0'; ++c) {
    if (!can_be_in_a_name(*c)) *c = '?';
  }
  return result;
}

HelloFit fit(const HelloSample& ours, const HelloSample& theirs) {
  if (ours.icd_hash != theirs.icd_hash) return HelloFit::kOtherInterface;
  if (std::memcmp(ours.target, theirs.target, sizeof ours.target) != 0) return HelloFit::kOtherTarget;
  const bool both_name_a_model = ours.model_crc32 != 0 && theirs.model_crc32 != 0;
  const bool other_model = both_name_a_model && ours.model_crc32 != theirs.model_crc32;
  return other_model ? HelloFit::kOtherModel : HelloFit::kFits;
}

}  // namespace tumblesight::hal::dds
