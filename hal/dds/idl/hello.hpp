// The hello of a program, and the check whether the two programs of a run match: they need the same interface
// definition, target and model image.
#pragma once

#include "hal/dds/idl/topics.hpp"

namespace tumblesight::hal::dds {

// `target` is cut off at the size of the field less one.
void set_target(HelloSample& hello, const char* target);

struct TargetText {
  char text[sizeof HelloSample::target + 1];
};
// For messages: what cannot be part of a target's name becomes '?', because any program can write a hello.
TargetText target_of(const HelloSample& hello);

enum class HelloFit { kFits, kOtherInterface, kOtherTarget, kOtherModel };
// The first difference. A model image is compared only if both sides name one.
HelloFit fit(const HelloSample& ours, const HelloSample& theirs);

}  // namespace tumblesight::hal::dds
