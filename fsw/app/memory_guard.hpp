// MemoryGuard: finds what radiation has done to the estimator's memory since the last cycle, and mends what
// it can. Bounded in time: config::kLimitRules says how many blocks of the model are checked in a cycle.
//
//   hit                                    found by                    mended from
//   state of LSTM and track                CRC of the last cycle's     copy of the last cycle's; if that is
//   hit too, reset biases, shifts, what load() has set    CRC at activation           model image weights, in
//   the bank in use            checksum of each block      second copy in the other bank, if it holds one
//   checksums of the blocks                CRC over the table          image, if its own CRCs find it whole
//   activations                            written anew every frame
#pragma once

#include "fsw/app/app_state.hpp"
#include "fsw/app/model_banks.hpp"
#include "gnc/rcnn/attitude_estimator.hpp"

namespace tumblesight::fsw {

template <class N>
class MemoryGuard {
 public:
  using Estimator = gnc::AttitudeEstimator<N>;

  // After a model has been activated.
  void model_activated(const Estimator& estimator, AppState& state);
  // At the start of a cycle. What could not be mended is in state.faults_seen.
  void check(Estimator& estimator, AppState& state, const Reporter& report);
  // At the end of a cycle.
  void keep(const Estimator& estimator, AppState& state);

 private:
  void check_state(Estimator& estimator, AppState& state, const Reporter& report);
  void check_constants(Estimator& estimator, AppState& state, const Reporter& report);
  void check_table(const Estimator& estimator, AppState& state, const Reporter& report);
  void check_block(AppState& state, const Reporter& report);
  void lose_model(AppState& state);

  ModelBanks<N> banks_;
  typename Estimator::State kept_;
};

}  // namespace tumblesight::fsw
