#include "fsw/programs/desktop/flight_program.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "fsw/programs/desktop/flight_options.hpp"

namespace tumblesight::fsw::desktop {

bool program_folder(char* folder, std::size_t size) {
  const ssize_t length = readlink("/proc/self/exe", folder, size - 1);
  if (length <= 0 || static_cast<std::size_t>(length) == size - 1) return false;
  folder[length] = '\0';
  char* slash = std::strrchr(folder, '/');
  if (slash == nullptr) return false;
  *slash = '\0';
  return true;
}

hal::dds::FlightEnd become_float32_program(char** argv) {
  char folder[FlightOptions::kMaxPath];
  char path[FlightOptions::kMaxPath + 16];
  if (program_folder(folder, sizeof folder)) {
    std::snprintf(path, sizeof path, "%s/flight_float32", folder);
    execv(path, argv);
    std::fprintf(stderr,
                 "%s: cannot start %s, the program for float32: %s; build its target: flight_float32 (CMake "
                 "option TUMBLESIGHT_FLOAT32)\n",
                 kProgramName, path, strerrordesc_np(errno));
  }
  return hal::dds::FlightEnd::kNoFloat32Program;
}

}  // namespace tumblesight::fsw::desktop
