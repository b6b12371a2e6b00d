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

struct LostPart {
  hal::StateLoss loss;
  const char* name;
};
constexpr LostPart kLostParts[] = {
    {hal::StateLoss::kHead, "command counter and key slot"},
    {hal::StateLoss::kBody, "mode, bank, disabled responses and parameter table"},
    {hal::StateLoss::kTable, "parameter table"},
    {hal::StateLoss::kStale, "the newest changes"},
    {hal::StateLoss::kKeySlot, "key slot (the stored one has no key)"},
    {hal::StateLoss::kModeAndBank, "mode and bank"},
};

void print_lost_parts(std::uint32_t lost) {
  const char* separator = "";
  for (const LostPart& part : kLostParts) {
    if ((lost & static_cast<std::uint32_t>(part.loss)) == 0) continue;
    std::fprintf(stderr, "%s%s", separator, part.name);
    separator = ", ";
  }
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

void report_state(const FlightOptions& options, const AttitudeInitApp& app) {
  const char* const path = options.state_path;
  const bool safe = app.mode() == Mode::kSafe;
  const std::uint32_t lost = app.state_lost();
  const bool kept_out = safe || app.mode() == Mode::kStandby;
  if (lost == 0 && !(kept_out && app.boot_status(0) == gnc::ModelStatus::kOk)) return;
  std::fprintf(stderr, "%s: --state %s: ", kProgramName, path);
  if (lost != 0) {
    std::fprintf(stderr, "not all of the stored state could be used; lost: ");
    print_lost_parts(lost);
    std::fprintf(stderr, "; load it again; ");
  }
  std::fprintf(stderr, "the mode is %s; send SET_MODE %s, or delete %s and %s.copy to start afresh\n",
               safe ? "SAFE" : "STANDBY", safe ? "STANDBY, then SET_MODE RUN" : "RUN", path, path);
}

}  // namespace tumblesight::fsw::desktop
