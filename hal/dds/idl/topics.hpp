// The topics of the SIL interface with name, type and quality of service, and typed readers and writers.
//
// All topics are reliable with a bounded history, because with KEEP_ALL a slow reader could block a writer. A
// history holds twice the samples of one lockstep step. Endpoints do not receive samples of their own
// participant.
#pragma once

#include <dds/dds.h>

#include <cstdint>

#include "hal/dds/idl/tumblesight.h"

namespace tumblesight::hal::dds {

inline constexpr int kMaxFramesPerStep = 8;
inline constexpr int kMaxCommandsPerStep = 32;
inline constexpr int kMaxEventsPerStep = 32;

using HelloSample = tumblesight_icd_Hello;
using LidarFrameSample = tumblesight_icd_LidarFrame;
using CommandSample = tumblesight_icd_Command;
using StepSample = tumblesight_icd_Step;
using AttitudeSample = tumblesight_icd_Attitude;
using TelemetrySample = tumblesight_icd_Telemetry;
using EventSample = tumblesight_icd_Event;
using ModelDumpSample = tumblesight_icd_ModelDump;
using StepDoneSample = tumblesight_icd_StepDone;
using TruthSample = tumblesight_icd_Truth;

enum class Role : std::uint8_t { kSimulator = 0, kFlight = 1 };

struct Topic {
  const char* name;
  const dds_topic_descriptor_t* type;
  int history;
  bool for_late_joiners;  // transient-local
};

template <class Sample>
const Topic& topic_of();
template <>
const Topic& topic_of<HelloSample>();
template <>
const Topic& topic_of<LidarFrameSample>();
template <>
const Topic& topic_of<CommandSample>();
template <>
const Topic& topic_of<StepSample>();
template <>
const Topic& topic_of<AttitudeSample>();
template <>
const Topic& topic_of<TelemetrySample>();
template <>
const Topic& topic_of<EventSample>();
template <>
const Topic& topic_of<ModelDumpSample>();
template <>
const Topic& topic_of<StepDoneSample>();
template <>
const Topic& topic_of<TruthSample>();

// Untyped functions. They return a positive entity handle or a negative DDS return code.
dds_entity_t create_writer(dds_entity_t participant, const Topic& topic);
dds_entity_t create_reader(dds_entity_t participant, const Topic& topic);
// Takes the oldest sample; skips notices without data. False: there is none.
bool take_one(dds_entity_t reader, void* sample);
int matched_readers(dds_entity_t writer);
int matched_writers(dds_entity_t reader);
// Whether a peer has the topic with another type or quality of service; such endpoints never match.
bool saw_incompatible_writer(dds_entity_t reader);
// Waits until all readers have acknowledged all samples. False: timeout.
bool wait_for_acknowledgment(dds_entity_t writer, std::int64_t timeout_ns);

template <class Sample>
class Writer {
 public:
  [[nodiscard]] dds_return_t open(dds_entity_t participant) {
    entity_ = create_writer(participant, topic_of<Sample>());
    return entity_ < 0 ? entity_ : 0;
  }
  [[nodiscard]] dds_return_t write(const Sample& sample) { return dds_write(entity_, &sample); }
  int matched() const { return matched_readers(entity_); }
  dds_entity_t entity() const { return entity_; }

 private:
  dds_entity_t entity_ = 0;
};

template <class Sample>
class Reader {
 public:
  [[nodiscard]] dds_return_t open(dds_entity_t participant) {
    entity_ = create_reader(participant, topic_of<Sample>());
    return entity_ < 0 ? entity_ : 0;
  }
  bool take(Sample& sample) { return take_one(entity_, &sample); }
  int matched() const { return matched_writers(entity_); }
  bool saw_incompatible() const { return saw_incompatible_writer(entity_); }
  dds_entity_t entity() const { return entity_; }

 private:
  dds_entity_t entity_ = 0;
};

}  // namespace tumblesight::hal::dds
