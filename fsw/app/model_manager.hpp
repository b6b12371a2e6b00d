// ModelManager: finds a model at boot, and validates, activates and switches models. It lives for one step;
// everything that it keeps is in AppState.
#pragma once

#include <cstdint>

#include "fsw/app/app_state.hpp"
#include "fsw/app/memory_scrubber.hpp"
#include "fsw/app/mode_manager.hpp"

namespace tumblesight::fsw {

class ModelManager {
 public:
  ModelManager(AppState& state, Estimator& estimator, MemoryScrubber& scrubber, const Reporter& report)
      : state_(state), estimator_(estimator), scrubber_(scrubber), report_(report) {}

  // Activates the image of the first bank that passes every check, beginning with `preferred`. A good image
  // in the other bank is kept as the second copy or as a fallback. Without a good image `preferred` stays the
  // bank in use. The result of each bank: AppState::boot_status.
  void boot(std::uint32_t preferred);
  // Reports the result of boot() once, in the first step after it.
  void report_boot();

  // The following check a whole image, which is a long task.

  // Checks the loaded image of the bank that is not in use. `crc32`: as in the image's header. With kOk
  // the bank becomes kGood.
  gnc::ModelStatus validate(std::uint32_t size_bytes, std::uint32_t crc32);
  // Checks the image of `bank` again and uses it. With any status except kOk the current model stays
  // in use.
  gnc::ModelStatus activate(std::uint32_t bank);
  // Once per cycle: continues the copy of the image in use, where an upload has it as its base.
  void continue_copy();
  // Response to the loss of the model in this cycle. Returns the response taken: kSwitchBank, or kSafe if the
  // other bank holds no good model.
  Response switch_bank(Fault fault, ModeManager& modes);

 private:
  void boot_bank(std::uint32_t bank);

  AppState& state_;
  Estimator& estimator_;
  MemoryScrubber& scrubber_;
  const Reporter& report_;
};

}  // namespace tumblesight::fsw
