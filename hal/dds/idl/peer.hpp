// Who is on the bus. DDS delivers the samples of every program in the domain, so each side binds its readers
// to the one participant that it met in the handshake. A further writer of our topics is foreign: its samples
// are dropped, and the run ends with its description.
#pragma once

#include <dds/dds.h>

#include <cstdint>

namespace tumblesight::hal::dds {

using PeerKey = dds_guid_t;  // of a participant

bool same_peer(const PeerKey& a, const PeerKey& b);

// The participant of a writer that is matched with `reader`. False: it is not matched any more.
[[nodiscard]] bool find_participant(dds_entity_t reader, dds_instance_handle_t writer, PeerKey& key);
// The first endpoint of `peer` that is matched with ours; 0: there is none.
dds_instance_handle_t writer_of(const PeerKey& peer, dds_entity_t reader);
dds_instance_handle_t reader_of(const PeerKey& peer, dds_entity_t writer);

struct MatchedWriters {
  bool bound = false;                 // whether the given writer is among them
  dds_instance_handle_t foreign = 0;  // any other one; 0: there is none
};
MatchedWriters matched_writers(dds_entity_t reader, dds_instance_handle_t bound);

// A program that is not the peer but writes a topic of ours, as far as it can be identified.
struct Foreigner {
  const char* topic = nullptr;   // nullptr: there is none
  PeerKey participant{};         // 0: it has left
  std::uint32_t process_id = 0;  // as it states it; 0: unknown

  explicit operator bool() const { return topic != nullptr; }
};
Foreigner describe_foreigner(const char* topic, dds_entity_t reader, dds_instance_handle_t writer);
Foreigner describe_foreigner(const char* topic, dds_entity_t reader, const PeerKey& participant);

// "sil/step is also written by participant 0110d8c3... (process 4711)"
struct ForeignerText {
  char text[160];
};
ForeignerText to_text(const Foreigner& foreigner);

}  // namespace tumblesight::hal::dds
