#include "fsw/programs/desktop/flight_model.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <type_traits>

#include "fsw/config/limits.hpp"
#include "fsw/config/numerics.hpp"
#include "gnc/rcnn/model_image.hpp"
#include "hal/posix/file_model_store.hpp"

namespace tumblesight::fsw::desktop {
namespace {

static_assert(gnc::kModelImageSize<gnc::Float32> <= fsw::config::kMaxModelImageBytes,
              "the limit would refuse every image");

// The folder of this program, without a slash at its end.
bool program_folder(char (&folder)[FlightOptions::kMaxPath]) {
  const ssize_t length = readlink("/proc/self/exe", folder, sizeof folder - 1);
  if (length <= 0) return false;
  folder[length] = '\0';
  char* slash = std::strrchr(folder, '/');
  if (slash == nullptr) return false;
  *slash = '\0';
  return true;
}

// Looks in the source tree around the build folder that this program is in, then in the source tree it was
// built from.
void find_shipped_model(FlightOptions& options) {
  char folder[FlightOptions::kMaxPath];
  char path[FlightOptions::kMaxPath + 128];
  const char* const kind = options.float32 ? ".float32" : "";
  if (program_folder(folder)) {
    const int length =
        std::snprintf(path, sizeof path, "%s/../../../fsw/models/%s%s.tsm", folder, options.target, kind);
    if (length > 0 && length < FlightOptions::kMaxPath && access(path, R_OK) == 0) {
      std::memcpy(options.model_path, path, static_cast<std::size_t>(length) + 1);
      return;
    }
  }
  std::snprintf(options.model_path, sizeof options.model_path, "%s/fsw/models/%s%s.tsm",
                TUMBLESIGHT_SOURCE_DIR, options.target, kind);
}

// Returns only if the program cannot be started.
void become_float32_program(char** argv) {
  char folder[FlightOptions::kMaxPath];
  char path[FlightOptions::kMaxPath + 16];
  if (!program_folder(folder)) return;
  std::snprintf(path, sizeof path, "%s/flight_float32", folder);
  execv(path, argv);
  std::fprintf(stderr, "flight: %s: %s\n", path, strerrordesc_np(errno));
}

}  // namespace

void boot(FlightOptions& options, AttitudeInitApp& app, const hal::Platform& platform, char** argv) {
  if (options.model_path[0] == '\0') find_shipped_model(options);
  static hal::posix::FileModelStore store(options.model_path, fsw::config::kMaxModelImageBytes);
  const hal::ModelBank image = store.bank(0);
  const bool float32 = options.numerics_given ? options.float32 : gnc::is_float32(image.data, image.size);
  constexpr bool kFlyFloat32 = std::is_same_v<fsw::Numerics, gnc::Float32>;
  if (float32 && !kFlyFloat32) become_float32_program(argv);
  hal::Platform complete = platform;
  complete.models = &store;
  app.init(complete, options.target);
  if (app.boot_status(0) == gnc::ModelStatus::kOk) return;
  const bool unread = store.status() != hal::posix::FileStatus::kOk;
  std::fprintf(stderr, "flight: model image %s: %s; the mode is SAFE\n", options.model_path,
               unread ? to_string(store.status()) : gnc::to_string(app.boot_status(0)));
}

}  // namespace tumblesight::fsw::desktop
