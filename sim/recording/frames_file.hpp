// Frames without a flight program as an MCAP file: the samples that the simulator would send (CDR, with
// tumblesight.idl as schema), with what viewers show without set-up. `tumblesight replay` and `tumblesight
// console` take it as they take the recording of a run.
#pragma once

#include <cstdint>
#include <string>

#include "sim/recording/step_source.hpp"

namespace tumblesight::sim {

// All steps of `source` into the file. `run_id`: any, which tells this recording from others. `swath_m`: of
// the truth (FrameTruth). Throws std::runtime_error if the file cannot be written.
void write_frames_file(const std::string& path, StepSource& source, const std::string& target,
                       std::uint32_t run_id, double swath_m);

}  // namespace tumblesight::sim
