#include "sim/sil/frame_faults.hpp"

#include <algorithm>

namespace tumblesight::sim {

void FrameFaults::begin(Kind kind, std::uint32_t steps) {
  kind_ = kind;
  left_ = steps;
}

void FrameFaults::apply(StepInput& input, FrameTruth& truth) {
  const bool is_on = left_ > 0;
  shown_ = std::move(delayed_);
  delayed_.clear();
  // Frames that waited come first, with the one of this step behind them.
  std::vector<const gnc::RangeImage*> frames;
  if (is_on) --left_;
  for (const gnc::RangeImage* frame : input.frames) {
    if (!is_on) {
      shown_.push_back(*frame);
    } else if (kind_ == Kind::kDelay) {
      delayed_.push_back(*frame);
    } else if (kind_ == Kind::kFreeze) {
      shown_.push_back(has_last_ ? last_ : *frame);
      shown_.back().sequence_number = frame->sequence_number;
      shown_.back().exposure_time_ns = frame->exposure_time_ns;
    }
  }
  for (const gnc::RangeImage& frame : shown_) frames.push_back(&frame);
  const bool is_frozen = is_on && kind_ == Kind::kFreeze && has_last_;
  if (is_frozen) frozen_for_ = std::max(truth.frozen_for, frozen_for_ + 1);
  if (!is_frozen) frozen_for_ = 0;
  if (is_frozen)
    truth.frozen_for = frozen_for_;
  else if (is_on && kind_ != Kind::kFreeze)
    truth.lost = true;
  if (!shown_.empty() && !is_frozen) {  // the first image of all is new, frozen or not
    last_ = shown_.back();
    has_last_ = true;
  }
  input.frames = frames;
}

bool read_fault(const std::string& name, FrameFaults::Kind& kind) {
  if (name == "drop")
    kind = FrameFaults::Kind::kDrop;
  else if (name == "freeze")
    kind = FrameFaults::Kind::kFreeze;
  else if (name == "delay")
    kind = FrameFaults::Kind::kDelay;
  else
    return false;
  return true;
}

}  // namespace tumblesight::sim
