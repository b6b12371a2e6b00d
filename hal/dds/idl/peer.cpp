#include "hal/dds/idl/peer.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace tumblesight::hal::dds {
namespace {

// Endpoints that are examined. One is the peer's; the participant indices of a domain allow 33 programs.
constexpr int kMaxMatches = 64;

struct Handles {
  dds_instance_handle_t values[kMaxMatches];
  int count = 0;
};

using GetMatches = dds_return_t (*)(dds_entity_t endpoint, dds_instance_handle_t* handles, size_t capacity);
using GetData = dds_builtintopic_endpoint_t* (*)(dds_entity_t endpoint, dds_instance_handle_t handle);

Handles matches_of(dds_entity_t endpoint, GetMatches get) {
  Handles handles;
  const dds_return_t count = get(endpoint, handles.values, kMaxMatches);
  handles.count = count < 0 ? 0 : (count < kMaxMatches ? count : kMaxMatches);
  return handles;
}

bool participant_of(dds_entity_t endpoint, dds_instance_handle_t other, GetData get, PeerKey& key) {
  dds_builtintopic_endpoint_t* const data = get(endpoint, other);
  if (data == nullptr) return false;
  key = data->participant_key;
  dds_builtintopic_free_endpoint(data);
  return true;
}

dds_instance_handle_t endpoint_of(const PeerKey& peer, dds_entity_t endpoint, GetMatches get_matches,
                                  GetData get_data) {
  const Handles handles = matches_of(endpoint, get_matches);
  for (int i = 0; i < handles.count; ++i) {
    PeerKey key;
    if (participant_of(endpoint, handles.values[i], get_data, key) && same_peer(key, peer))
      return handles.values[i];
  }
  return 0;
}

std::uint32_t process_id_in(const dds_qos_t* qos) {
  char* text = nullptr;
  if (qos == nullptr || !dds_qget_prop(qos, "__Pid", &text)) return 0;
  const auto id = static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10));
  dds_free(text);
  return id;
}

// Participants publish the id of their process with their discovery data.
std::uint32_t process_id_of(dds_entity_t participant, const PeerKey& key) {
  const dds_entity_t reader =
      dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr);
  if (reader < 0) return 0;
  void* samples[kMaxMatches] = {};
  dds_sample_info_t infos[kMaxMatches];
  std::uint32_t process_id = 0;
  const dds_return_t count = dds_read(reader, samples, infos, kMaxMatches, kMaxMatches);
  for (dds_return_t i = 0; i < count; ++i) {
    if (!infos[i].valid_data) continue;
    const auto* const data = static_cast<const dds_builtintopic_participant_t*>(samples[i]);
    if (same_peer(data->key, key)) process_id = process_id_in(data->qos);
  }
  if (count > 0) (void)dds_return_loan(reader, samples, count);
  dds_delete(reader);
  return process_id;
}

}  // namespace

bool same_peer(const PeerKey& a, const PeerKey& b) {
  return std::memcmp(a.v, b.v, sizeof a.v) == 0;
}

bool find_participant(dds_entity_t reader, dds_instance_handle_t writer, PeerKey& key) {
  return participant_of(reader, writer, dds_get_matched_publication_data, key);
}

dds_instance_handle_t writer_of(const PeerKey& peer, dds_entity_t reader) {
  return endpoint_of(peer, reader, dds_get_matched_publications, dds_get_matched_publication_data);
}

dds_instance_handle_t reader_of(const PeerKey& peer, dds_entity_t writer) {
  return endpoint_of(peer, writer, dds_get_matched_subscriptions, dds_get_matched_subscription_data);
}

MatchedWriters matched_writers(dds_entity_t reader, dds_instance_handle_t bound) {
  MatchedWriters result;
  const Handles handles = matches_of(reader, dds_get_matched_publications);
  for (int i = 0; i < handles.count; ++i) {
    if (handles.values[i] == bound) {
      result.bound = true;
    } else {
      result.foreign = handles.values[i];
    }
  }
  return result;
}

Foreigner describe_foreigner(const char* topic, dds_entity_t reader, dds_instance_handle_t writer) {
  PeerKey participant{};
  (void)find_participant(reader, writer, participant);
  return describe_foreigner(topic, reader, participant);
}

Foreigner describe_foreigner(const char* topic, dds_entity_t reader, const PeerKey& participant) {
  return {topic, participant, process_id_of(dds_get_participant(reader), participant)};
}

ForeignerText to_text(const Foreigner& foreigner) {
  char key[2 * sizeof foreigner.participant.v + 1];
  for (std::size_t i = 0; i < sizeof foreigner.participant.v; ++i)
    std::snprintf(key + 2 * i, 3, "%02x", foreigner.participant.v[i]);
  char process[32] = "unknown process";
  if (foreigner.process_id != 0)
    std::snprintf(process, sizeof process, "process %u", static_cast<unsigned>(foreigner.process_id));
  ForeignerText result;
  std::snprintf(result.text, sizeof result.text, "%s is also written by participant %s (%s)",
                foreigner.topic == nullptr ? "-" : foreigner.topic, key, process);
  return result;
}

}  // namespace tumblesight::hal::dds
