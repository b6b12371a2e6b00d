#include "hal/dds/idl/topics.hpp"

namespace tumblesight::hal::dds {
namespace {

// Maximum time that a writer waits for a full reader; not reached with KEEP_LAST.
constexpr dds_duration_t kMaxBlocking = DDS_MSECS(100);

constexpr Topic kHello{"sil/hello", &tumblesight_icd_Hello_desc, 4, true};
constexpr Topic kLidarFrame{"sil/lidar_frame", &tumblesight_icd_LidarFrame_desc, 2 * kMaxFramesPerStep,
                            false};
constexpr Topic kNavigation{"sil/navigation", &tumblesight_icd_Navigation_desc, 2 * kMaxFramesPerStep, false};
constexpr Topic kCommand{"sil/command", &tumblesight_icd_Command_desc, 2 * kMaxCommandsPerStep, false};
constexpr Topic kStep{"sil/step", &tumblesight_icd_Step_desc, 4, false};
constexpr Topic kAttitude{"sil/attitude", &tumblesight_icd_Attitude_desc, 8, false};
constexpr Topic kTelemetry{"sil/telemetry", &tumblesight_icd_Telemetry_desc, 8, false};
constexpr Topic kEvent{"sil/event", &tumblesight_icd_Event_desc, 2 * kMaxEventsPerStep, false};
constexpr Topic kMemoryDump{"sil/memory_dump", &tumblesight_icd_MemoryDump_desc, 8, false};
constexpr Topic kStepDone{"sil/step_done", &tumblesight_icd_StepDone_desc, 8, false};
constexpr Topic kTruth{"sil/truth", &tumblesight_icd_Truth_desc, 8, false};

dds_qos_t* qos_of(const Topic& topic, const char* partition) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, kMaxBlocking);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, topic.history);
  dds_qset_durability(qos, topic.for_late_joiners ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_ignorelocal(qos, DDS_IGNORELOCAL_PARTICIPANT);
  if (partition[0] != '\0') dds_qset_partition1(qos, partition);
  return qos;
}

using Create = dds_entity_t (*)(dds_entity_t participant, dds_entity_t topic, const dds_qos_t* qos,
                                const dds_listener_t* listener);

dds_entity_t create(dds_entity_t participant, const char* partition, const Topic& topic,
                    Create create_endpoint) {
  const dds_entity_t handle = dds_create_topic(participant, topic.type, topic.name, nullptr, nullptr);
  if (handle < 0) return handle;
  dds_qos_t* qos = qos_of(topic, partition);
  const dds_entity_t endpoint = create_endpoint(participant, handle, qos, nullptr);
  dds_delete_qos(qos);
  return endpoint;
}

}  // namespace

template <>
const Topic& topic_of<HelloSample>() {
  return kHello;
}
template <>
const Topic& topic_of<LidarFrameSample>() {
  return kLidarFrame;
}
template <>
const Topic& topic_of<NavigationSample>() {
  return kNavigation;
}
template <>
const Topic& topic_of<CommandSample>() {
  return kCommand;
}
template <>
const Topic& topic_of<StepSample>() {
  return kStep;
}
template <>
const Topic& topic_of<AttitudeSample>() {
  return kAttitude;
}
template <>
const Topic& topic_of<TelemetrySample>() {
  return kTelemetry;
}
template <>
const Topic& topic_of<EventSample>() {
  return kEvent;
}
template <>
const Topic& topic_of<MemoryDumpSample>() {
  return kMemoryDump;
}
template <>
const Topic& topic_of<StepDoneSample>() {
  return kStepDone;
}
template <>
const Topic& topic_of<TruthSample>() {
  return kTruth;
}

dds_entity_t create_writer(const Domain& domain, const Topic& topic) {
  return create(domain.participant(), domain.partition(), topic, dds_create_writer);
}

dds_entity_t create_reader(const Domain& domain, const Topic& topic) {
  return create_reader(domain, domain.participant(), topic);
}

dds_entity_t create_reader(const Domain& domain, dds_entity_t participant, const Topic& topic) {
  return create(participant, domain.partition(), topic, dds_create_reader);
}

dds_return_t BoundReader::open(const Domain& domain, const Topic& topic) {
  name_ = topic.name;
  entity_ = create_reader(domain, topic);
  return entity_ < 0 ? entity_ : 0;
}

bool BoundReader::bind(const PeerKey& peer) {
  bound_ = writer_of(peer, entity_);
  return bound_ != 0;
}

Foreigner BoundReader::foreigner() const {
  if (dropped_ || bound_ == 0) return dropped_;
  const dds_instance_handle_t writer = matched_writers(entity_, bound_).foreign;
  return writer == 0 ? Foreigner{} : describe_foreigner(name_, entity_, writer);
}

// Skips notices without data, and drops samples of foreign writers.
bool BoundReader::take_untyped(void* sample, dds_instance_handle_t& writer) {
  constexpr int kMaxSkipped = 64;
  for (int i = 0; i < kMaxSkipped; ++i) {
    dds_sample_info_t info;
    if (dds_take(entity_, &sample, &info, 1, 1) <= 0) return false;
    if (!info.valid_data) continue;
    writer = info.publication_handle;
    if (bound_ == 0 || writer == bound_) return true;
    if (!dropped_) dropped_ = describe_foreigner(name_, entity_, writer);
  }
  return false;
}

Mismatch latest_mismatch(dds_entity_t reader) {
  dds_requested_incompatible_qos_status_t status{};
  if (dds_get_requested_incompatible_qos_status(reader, &status) != 0 || status.total_count == 0)
    return Mismatch::kNone;
  return status.last_policy_id == DDS_PARTITION_QOS_POLICY_ID ? Mismatch::kPartition : Mismatch::kInterface;
}

bool wait_for_acknowledgment(dds_entity_t writer, std::int64_t timeout_ns) {
  return dds_wait_for_acks(writer, timeout_ns) == 0;
}

}  // namespace tumblesight::hal::dds
