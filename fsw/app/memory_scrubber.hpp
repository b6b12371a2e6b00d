// MemoryScrubber: finds bit flips in the estimator's memory since the last cycle and repairs them. Its time
// is bounded: the parameter ScrubBlocks limits the model blocks checked per cycle, and a cycle has at most
// one of the long repairs marked *, which AppState::begin_long_task() grants. What is still corrupted is
// found again and repaired in the next cycle, and no frame is estimated meanwhile. Everything is repaired
// within kMostRepairCycles.
//
//   corrupted                      found by                        repaired from
//   state of LSTM and track        CRC of the last cycle           copy of the last cycle; reset if the copy
//                                                                  is corrupted too
//   biases, shifts, everything     CRC at activation               model image *
//   that load() sets
//   weights in the bank in use     checksum of each block          second copy in the other bank, if any
//   a different good image in      checksum of each block          nothing; the bank is EMPTY from then on
//   the other bank
//   checksums of the blocks        CRC over each bank's table      table of the second copy; image, if its
//                                                                  own CRCs are correct *
//   activations                    not checked                     rewritten in every frame
#pragma once

#include "fsw/app/app_state.hpp"
#include "fsw/app/model_banks.hpp"

namespace tumblesight::fsw {

class MemoryScrubber {
 public:
  // Two tables of banks and the constants, one per cycle.
  static constexpr int kMostRepairCycles = 3;

  // Call after the image of a bank has passed every check.
  void bank_is_good(std::uint32_t bank, AppState& state);
  // Call after a model has been activated.
  void model_activated(const Estimator& estimator, AppState& state);
  // Resets values of the state that index an array or limit a loop if they are out of range: majority voting
  // cannot correct the same bit in two copies. False: something, or the mode, was out of range.
  [[nodiscard]] static bool bound(const Estimator& estimator, AppState& state);
  // At the start of a cycle. Damage that cannot be repaired is set in state.faults_seen.
  void check(Estimator& estimator, AppState& state, const Reporter& report);
  // At the end of a cycle: keeps a copy of the estimator's state and its CRC.
  void keep(const Estimator& estimator, AppState& state);

 private:
  void check_state(Estimator& estimator, AppState& state, const Reporter& report);
  void check_constants(Estimator& estimator, AppState& state, const Reporter& report);
  // False: the bank is lost, or its table is repaired in a later cycle; long_task is set.
  [[nodiscard]] bool has_sound_table(std::uint32_t bank, const Estimator& estimator, AppState& state,
                                     const Reporter& report);
  // False: the image of the bank does not pass every check.
  [[nodiscard]] bool rebuild_table(std::uint32_t bank, const Estimator& estimator, AppState& state);
  void check_block(AppState& state, const Reporter& report);
  void lose_model(AppState& state);
  void lose_fallback(AppState& state, const Reporter& report);

  ModelBanks banks_;
  Estimator::State kept_;
};

}  // namespace tumblesight::fsw
