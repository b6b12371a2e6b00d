// MemoryGuard: finds bit flips in the estimator's memory since the last cycle and repairs them. Its time is
// bounded: config::kLimitRules limits the model blocks checked per cycle.
//
//   corrupted                      found by                        repaired from
//   state of LSTM and track        CRC of the last cycle           copy of the last cycle; reset if the copy
//                                                                  is corrupted too
//   biases, shifts, everything     CRC at activation               model image
//   that load() sets
//   weights in the bank in use     checksum of each block          second copy in the other bank, if any
//   checksums of the blocks        CRC over the table              image, if its own CRCs are correct
//   activations                    not checked                     rewritten in every frame
#pragma once

#include "fsw/app/app_state.hpp"
#include "fsw/app/model_banks.hpp"

namespace tumblesight::fsw {

class MemoryGuard {
 public:
  // Call after a model has been activated.
  void model_activated(const Estimator& estimator, AppState& state);
  // At the start of a cycle. Damage that cannot be repaired is set in state.faults_seen.
  void check(Estimator& estimator, AppState& state, const Reporter& report);
  // At the end of a cycle: keeps a copy of the estimator's state and its CRC.
  void keep(const Estimator& estimator, AppState& state);

 private:
  void check_state(Estimator& estimator, AppState& state, const Reporter& report);
  void check_constants(Estimator& estimator, AppState& state, const Reporter& report);
  void check_table(const Estimator& estimator, AppState& state, const Reporter& report);
  void check_block(AppState& state, const Reporter& report);
  void lose_model(AppState& state);

  ModelBanks banks_;
  Estimator::State kept_;
};

}  // namespace tumblesight::fsw
