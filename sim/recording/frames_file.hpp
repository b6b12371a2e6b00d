// Writes frames to an MCAP file without a flight program: the samples that the simulator would send (CDR,
// with tumblesight.idl as schema), and messages that viewers show without set-up. `tumblesight replay` and
// `tumblesight console` accept the file like the recording of a run.
#pragma once

#include <cstdint>
#include <string>

#include "sim/recording/step_source.hpp"

namespace tumblesight::sim {

// Writes all steps of `source`. `run_id`: any number that distinguishes this recording from others.
// `swath_m`: of the truth (FrameTruth). Throws std::runtime_error if the file cannot be written.
void write_frames_file(const std::string& path, StepSource& source, const std::string& target,
                       std::uint32_t run_id, double swath_m);

}  // namespace tumblesight::sim
