// The files of --state: the check before their use, and what a user must know of the state at the start.
#pragma once

#include "fsw/app/attitude_init_app.hpp"
#include "fsw/programs/desktop/flight_options.hpp"
#include "hal/posix/file_persistent_store.hpp"

namespace tumblesight::fsw::desktop {

// Uses the files of options.state_path, which is not empty. Returns false if they are no state files, cannot
// be written, or are the file of --packets: the reason and the remedy are written to the standard error
// stream, and no file has changed.
[[nodiscard]] bool open_state(const FlightOptions& options, hal::posix::FilePersistentStore& store);

// After the boot: writes to the standard error stream what of the state is lost, or that the state keeps the
// application out of RUN, and the remedy.
void report_state(const FlightOptions& options, const AttitudeInitApp& app);

}  // namespace tumblesight::fsw::desktop
