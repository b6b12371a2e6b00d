#include "fsw/programs/desktop/flight_state.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "fsw/app/stored_state.hpp"
#include "fsw/programs/desktop/flight_program.hpp"

namespace tumblesight::fsw::desktop {
namespace {

using hal::posix::FilePersistentStore;
using hal::posix::StoreFileCheck;
using hal::posix::StoreFileStatus;

StoreFileCheck check(const FilePersistentStore& store) {
  std::array<std::uint8_t, FilePersistentStore::kMagicBytes> magic{};
  const hal::StoredBytes record = to_record(StoredState{}, 0);
  std::copy_n(record.begin(), magic.size(), magic.begin());
  return store.check(magic);
}

const char* reason_of(const StoreFileCheck& result) {
  switch (result.status) {
    case StoreFileStatus::kNotARegularFile:
      return "is not a regular file; give the path of a state file or of a new one";
    case StoreFileStatus::kNotARecord:
      return "is not a state file; give another path, or delete this file";
    case StoreFileStatus::kFailed:
      return strerrordesc_np(result.error);
    case StoreFileStatus::kUsable:
      break;
  }
  return "ok";
}

// Something was stored, and neither copy has more than a head.
bool is_lost(FilePersistentStore& store) {
  int blank = 0;
  for (int copy = 0; copy < hal::kStoredCopies; ++copy) {
    hal::StoredBytes bytes{};
    StoredState state;
    std::uint32_t generation = 0;
    const StoreStatus status = store.read(copy, bytes);
    if (status == StoreStatus::kBlank) ++blank;
    if (status == StoreStatus::kOk && has_body(from_record(bytes, state, generation))) return false;
  }
  return blank < hal::kStoredCopies;
}

}  // namespace

bool open_state(const FlightOptions& options, FilePersistentStore& store) {
  const char* const path = options.state_path;
  const bool fits = store.use(path);
  if (!fits || (options.packets_path[0] != '\0' && store.uses(options.packets_path))) {
    std::fprintf(stderr, "%s: --state %s: %s\n", kProgramName, path,
                 fits ? "is the file of --packets, too" : "the path is too long");
    return false;
  }
  const StoreFileCheck result = check(store);
  if (result.status == StoreFileStatus::kUsable) return true;
  std::fprintf(stderr, "%s: --state %s: ", kProgramName, path);
  if (std::strcmp(result.path, path) != 0) std::fprintf(stderr, "%s: ", result.path);
  std::fprintf(stderr, "%s\n", reason_of(result));
  return false;
}

void report_state(const FlightOptions& options, const AttitudeInitApp& app, FilePersistentStore& store) {
  const char* const path = options.state_path;
  const bool safe = app.mode() == Mode::kSafe;
  if (is_lost(store)) {
    std::fprintf(stderr,
                 "%s: --state %s: the stored state is damaged or of other software; the mode is SAFE; "
                 "delete %s and %s.copy to start afresh\n",
                 kProgramName, path, path, path);
  } else if ((safe || app.mode() == Mode::kStandby) && app.boot_status(0) == gnc::ModelStatus::kOk) {
    std::fprintf(
        stderr,
        "%s: --state %s: the mode is %s; send SET_MODE %s, or delete %s and %s.copy to start afresh\n",
        kProgramName, path, safe ? "SAFE" : "STANDBY", safe ? "STANDBY, then SET_MODE RUN" : "RUN", path,
        path);
  }
}

}  // namespace tumblesight::fsw::desktop
