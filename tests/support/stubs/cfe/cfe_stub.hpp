// A cFE for tests: an app's main function runs in it until the messages of its script are used up. Every call
// can be made to fail.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/stubs/cfe/cfe.h"

namespace tumblesight::cfe {

using Bytes = std::vector<std::uint8_t>;

struct SentEvent {
  int id = 0, type = 0;
  std::string text;
};

struct SentMessage {
  Bytes bytes;
  bool is_origination = false;
  std::uint32_t message_id() const { return static_cast<std::uint32_t>(bytes[0] << 8 | bytes[1]); }
};

// A message that fills whole buffers, with the ids and sizes that cFE reads from it.
Bytes make_message(std::uint32_t message_id, std::size_t size_bytes);
// From a structure whose first bytes are its header: sets id and size.
template <class Structure>
Bytes message_of(std::uint32_t message_id, const Structure& structure,
                 std::size_t size_bytes = sizeof(Structure)) {
  Bytes bytes = make_message(message_id, size_bytes);
  const auto* const from = reinterpret_cast<const std::uint8_t*>(&structure);
  for (std::size_t i = sizeof(CFE_MSG_Message_t); i < size_bytes; ++i) bytes[i] = from[i];
  return bytes;
}

CFE_TIME_SysTime_t to_cfe_time(std::int64_t time_ns);

struct Cfe {
  // What ReceiveBuffer delivers: before each message, its function is called.
  struct Delivery {
    std::function<void()> before;
    Bytes message;
  };
  std::deque<Delivery> script;
  void deliver(const Bytes& message, const std::function<void()>& before = {}) {
    script.push_back({before, message});
  }

  int periods = 0;                   // in which an app without a pipe runs
  std::deque<std::int64_t> late_ns;  // by which the next delays last longer

  // Calls that fail, with their status; "CFE_SB_SubscribeEx:0x19F0" and the like for one argument alone.
  std::map<std::string, CFE_Status_t> failing;
  std::map<std::string, int> calls;
  bool has_buffers = true;
  std::int64_t met_ns = 0;
  bool is_operational = false;  // before this app was started
  int reset_type = CFE_PSP_RST_TYPE_POWERON;
  std::uint32_t reset_subtype = CFE_PSP_RST_SUBTYPE_POWER_CYCLE;
  std::map<std::string, Bytes> files;  // by path
  std::size_t most_bytes_per_read = 4096;
  std::map<std::string, std::optional<Bytes>> stored;  // the CDS by name; empty: registered, never written
  std::optional<Bytes> table;                          // the active one
  Bytes table_file;                                    // what CFE_TBL_Load() reads
  bool table_is_new = false;

  // What the app did.
  std::vector<SentEvent> events;
  std::vector<SentMessage> sent;
  std::vector<std::string> system_log;
  std::map<std::uint32_t, int> message_limits;
  int pipe_depth = 0;
  std::uint32_t exit_status = 0;
  std::vector<std::uint32_t> perf_log;  // markers, an exit plus 0x80000000
  std::vector<CFE_EVS_BinFilter_t> filters;
  std::vector<std::uint32_t> delays_ms;
  int buffers_in_use = 0, files_open = 0, addresses_held = 0;

  int count_events(int id) const {
    int count = 0;
    for (const SentEvent& event : events) count += event.id == id ? 1 : 0;
    return count;
  }
  // The text of the last event with this id; "": there is none.
  std::string text_of(int id) const {
    for (auto event = events.rbegin(); event != events.rend(); ++event)
      if (event->id == id) return event->text;
    return {};
  }

  // The ground loads a table: the app's validation decides.
  CFE_Status_t load_table(const Bytes& bytes);

  // Internals of the calls.
  struct OpenFile {
    Bytes bytes;
    std::size_t at = 0;
  };
  std::map<osal_id_t, OpenFile> open_files;
  std::vector<std::string> stored_names;
  std::vector<CFE_SB_Buffer_t> receive_buffer;
  std::vector<std::vector<CFE_SB_Buffer_t>> send_buffers;
  CFE_TBL_CallbackFuncPtr_t validate = nullptr;
  std::size_t table_bytes = 0;

  std::optional<CFE_Status_t> failure(const std::string& call);
};

// The one that the calls use.
Cfe& the_cfe();
// Another one, as at power-on.
void restart_cfe();

}  // namespace tumblesight::cfe
