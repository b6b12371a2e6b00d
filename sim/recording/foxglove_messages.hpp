// What a run shows in Foxglove, Lichtblick and PlotJuggler without set-up: messages of Foxglove's well-known
// schemas, and the figures of a step for plots, as JSON.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "hal/messages/attitude_report.hpp"
#include "hal/messages/event.hpp"
#include "sim/world/sensor/frame_truth.hpp"

namespace tumblesight::sim {

// What viewers show of a run: one channel each, the same live and in recordings.
enum class View : std::uint8_t { kPoints, kTransforms, kLog, kFigures };
inline constexpr std::array<View, 4> kViews{View::kPoints, View::kTransforms, View::kLog, View::kFigures};

struct ShownChannel {
  const char* topic;
  const char* schema_name;
  const char* schema;  // JSON schema
};
const ShownChannel& shown_channel(View view);

// ShownTime: times of messages are not negative. Those of a run may be: then they count from its first step.
class ShownTime {
 public:
  // The first call in a run counts.
  void begin_with(std::int64_t first_ns) {
    if (!first_ns_) first_ns_ = first_ns;
  }
  std::int64_t operator()(std::int64_t time_ns) const {
    return std::max<std::int64_t>(0, time_ns - std::min<std::int64_t>(0, first_ns_.value_or(0)));
  }

 private:
  std::optional<std::int64_t> first_ns_;
};

// What is known of a step, or a part of it.
struct ShownStep {
  std::int64_t time_ns = 0;                     // of its messages
  std::vector<const gnc::RangeImage*> frames;   // that were sent
  const hal::AttitudeReport* report = nullptr;  // null: there is no answer
  const FrameTruth* truth = nullptr;            // of the report's attitude, if it has one; null: not known
  double swath_m = 0.0;                         // of the truth
  std::vector<hal::Event> events;
};
// Its messages for a viewer, in order: points of each frame; frames of the target, if there is an answer or a
// truth; a text for each event; figures of the answer. With times that are not negative.
std::vector<std::string> messages_of(const ShownStep& step, const ShownTime& time, View view);

}  // namespace tumblesight::sim
