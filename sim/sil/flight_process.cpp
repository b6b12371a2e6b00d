#include "sim/sil/flight_process.hpp"

#include <stdexcept>

#include "hal/dds/idl/flight_end.hpp"
#include "sim/sil/failure.hpp"

namespace tumblesight::sim {

FlightProcess::FlightProcess(const std::string& program, const std::vector<std::string>& arguments,
                             const std::string& log_path, int inherited_file,
                             const std::vector<std::string>& environment) try
    : ChildProcess(program, arguments, log_path, inherited_file, environment) {
} catch (const ProgramFailure& error) {
  throw SilFailure(std::string("the flight program ") + error.what());
} catch (const std::runtime_error& error) {
  throw SilFailure(error.what());
}

std::string FlightProcess::how_it_ended() const {
  const int status = exit_status();
  if (status < 0) return ChildProcess::how_it_ended();
  return ChildProcess::how_it_ended() + ": " + hal::dds::to_string(static_cast<hal::dds::FlightEnd>(status));
}

}  // namespace tumblesight::sim
