// The topics of the SIL interface with name, type and quality of service, and typed readers and writers.
//
// All topics are reliable with a bounded history, because with KEEP_ALL a slow reader could block a writer. A
// history holds twice the samples of one lockstep step. Endpoints do not receive samples of their own
// participant.
#pragma once

#include <dds/dds.h>

#include <cstdint>

#include "hal/dds/idl/domain.hpp"
#include "hal/dds/idl/peer.hpp"
#include "hal/dds/idl/tumblesight.h"

namespace tumblesight::hal::dds {

inline constexpr int kMaxFramesPerStep = 8;  // and attitudes of the chaser
inline constexpr int kMaxCommandsPerStep = 32;
inline constexpr int kMaxEventsPerStep = 32;

using HelloSample = tumblesight_icd_Hello;
using LidarFrameSample = tumblesight_icd_LidarFrame;
using NavigationSample = tumblesight_icd_Navigation;
using CommandSample = tumblesight_icd_Command;
using StepSample = tumblesight_icd_Step;
using AttitudeSample = tumblesight_icd_Attitude;
using TelemetrySample = tumblesight_icd_Telemetry;
using EventSample = tumblesight_icd_Event;
using MemoryDumpSample = tumblesight_icd_MemoryDump;
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
const Topic& topic_of<NavigationSample>();
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
const Topic& topic_of<MemoryDumpSample>();
template <>
const Topic& topic_of<StepDoneSample>();
template <>
const Topic& topic_of<TruthSample>();

// Untyped functions. They return a positive entity handle or a negative DDS return code.
dds_entity_t create_writer(const Domain& domain, const Topic& topic);
dds_entity_t create_reader(const Domain& domain, const Topic& topic);
// Of another participant of the domain (Domain::join()).
dds_entity_t create_reader(const Domain& domain, dds_entity_t participant, const Topic& topic);
// What kept a writer of the topic from a reader. Such endpoints never match.
enum class Mismatch {
  kNone,
  kPartition,  // it belongs to another run in the domain
  kInterface,  // another type or quality of service: it was built from another interface definition
};
Mismatch latest_mismatch(dds_entity_t reader);
// Waits until all readers have acknowledged all samples. False: timeout.
bool wait_for_acknowledgment(dds_entity_t writer, std::int64_t timeout_ns);

template <class Sample>
class Writer {
 public:
  [[nodiscard]] dds_return_t open(const Domain& domain) {
    entity_ = create_writer(domain, topic_of<Sample>());
    return entity_ < 0 ? entity_ : 0;
  }
  [[nodiscard]] dds_return_t write(const Sample& sample) { return dds_write(entity_, &sample); }
  bool has_reader_of(const PeerKey& peer) const { return reader_of(peer, entity_) != 0; }
  dds_entity_t entity() const { return entity_; }

 private:
  dds_entity_t entity_ = 0;
};

// A reader takes the samples of every writer until it is bound, and of the peer alone from then on.
class BoundReader {
 public:
  // Binds to the peer's writer of the topic. False: there is none yet.
  bool bind(const PeerKey& peer);
  // Whether the peer's writer is still there.
  bool has_peer() const { return matched_writers(entity_, bound_).bound; }
  // A program other than the peer that writes the topic, now or in a sample that was dropped.
  Foreigner foreigner() const;  // none while unbound

  // A participant that wrote a sample which the peer would not write.
  Foreigner describe(const PeerKey& participant) const {
    return describe_foreigner(name_, entity_, participant);
  }

  Mismatch latest_mismatch() const { return dds::latest_mismatch(entity_); }
  dds_entity_t entity() const { return entity_; }

 protected:
  [[nodiscard]] dds_return_t open(const Domain& domain, const Topic& topic);
  bool take_untyped(void* sample, dds_instance_handle_t& writer);

 private:
  const char* name_ = "";
  dds_entity_t entity_ = 0;
  dds_instance_handle_t bound_ = 0;
  Foreigner dropped_{};  // writer of the first sample that was dropped
};

template <class Sample>
class Reader : public BoundReader {
 public:
  [[nodiscard]] dds_return_t open(const Domain& domain) {
    return BoundReader::open(domain, topic_of<Sample>());
  }
  // Takes the oldest sample. False: there is none.
  bool take(Sample& sample) {
    dds_instance_handle_t writer = 0;
    return take_untyped(&sample, writer);
  }
  // Also gives the participant that wrote it. Samples of participants that have left are skipped.
  bool take(Sample& sample, PeerKey& from) {
    dds_instance_handle_t writer = 0;
    while (take_untyped(&sample, writer)) {
      if (find_participant(entity(), writer, from)) return true;
    }
    return false;
  }
};

}  // namespace tumblesight::hal::dds
