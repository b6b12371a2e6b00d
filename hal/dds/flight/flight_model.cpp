#include "hal/dds/flight/flight_model.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstring>

#include "fsw/config/limits.hpp"
#include "gnc/rcnn/model_image.hpp"
#include "hal/posix/file_model_store.hpp"

namespace tumblesight::hal::dds {
namespace {

static_assert(gnc::kModelImageSize<gnc::Float32> <= fsw::config::kMaxModelImageBytes, "the limit would refuse every image");

// The folder that this program lies in, without a slash at its end.
bool program_folder(char (&folder)[FlightOptions::kMaxPath]) {
  const ssize_t length = readlink("/proc/self/exe", folder, sizeof folder - 1);
  if (length <= 0) return false;
  folder[length] = '\0';
  char* slash = std::strrchr(folder, '/');
  if (slash == nullptr) return false;
  *slash = '\0';
  return true;
}

// In a build folder of the source tree, or wherever the sources were when this was built.
void find_shipped_model(FlightOptions& options) {
  char folder[FlightOptions::kMaxPath];
  char path[FlightOptions::kMaxPath + 128];
  const char* const kind = options.float32 ? ".float32" : "";
  if (program_folder(folder)) {
    const int length = std::snprintf(path, sizeof path, "%s/../../../fsw/models/%s%s.tsm", folder, options.target, kind);
    if (length > 0 && length < FlightOptions::kMaxPath && access(path, R_OK) == 0) {
      std::strcpy(options.model_path, path);
      return;
    }
  }
  std::snprintf(options.model_path, sizeof options.model_path, "%s/fsw/models/%s%s.tsm", TUMBLESIGHT_SOURCE_DIR,
                options.target, kind);
}

}  // namespace

fsw::App& load_model(FlightOptions& options, FlightApps& apps, Stopwatch& stopwatch) {
  if (options.model_path[0] == '\0') find_shipped_model(options);
  static posix::FileModelStore store(options.model_path, fsw::config::kMaxModelImageBytes);
  const ModelBytes image = store.active_image();
  const bool float32 = options.numerics_given ? options.float32 : gnc::is_float32(image.data, image.size);
  fsw::App& app = float32 ? static_cast<fsw::App&>(apps.float32) : apps.fixed_point;
  app.init(image.data, image.size, options.target, stopwatch);
  if (app.mode() != fsw::Mode::kStandby) return app;
  const char* reason = image.data == nullptr ? to_string(store.status()) : gnc::to_string(app.model_status());
  std::fprintf(stderr, "flight: model image %s: %s; staying in STANDBY\n", options.model_path, reason);
  return app;
}

}  // namespace tumblesight::hal::dds
