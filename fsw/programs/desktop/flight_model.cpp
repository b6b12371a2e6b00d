#include "fsw/programs/desktop/flight_model.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstring>

#include "fsw/config/limits.hpp"
#include "fsw/programs/desktop/flight_program.hpp"
#include "gnc/rcnn/model_image.hpp"

namespace tumblesight::fsw::desktop {
namespace {

static_assert(gnc::kModelImageSize<gnc::Float32> <= fsw::config::kMaxModelImageBytes,
              "the limit would refuse every image");

// Writes the path of a folder that is named as seen from the folder of this program. Returns false if there
// is no such folder.
bool find_from_program(const char* name, char* path, std::size_t size) {
  char own[FlightOptions::kMaxPath];
  if (!program_folder(own, sizeof own)) return false;
  const int length = std::snprintf(path, size, "%s/%s", own, name);
  return length > 0 && static_cast<std::size_t>(length) < size && access(path, X_OK) == 0;
}

// Looks in the data of an installed program, then in the source tree of the build folder that this program
// is in.
void find_shipped_model(FlightOptions& options) {
  char folder[FlightOptions::kMaxPath - 128];  // room for the name of the image
  const bool found = find_from_program(TUMBLESIGHT_INSTALLED_DATA "/models", folder, sizeof folder) ||
                     find_from_program(TUMBLESIGHT_SOURCE_LINK "/fsw/models", folder, sizeof folder);
  std::snprintf(options.model_path, sizeof options.model_path, "%s/%s%s.tsm", found ? folder : "models",
                options.target, options.float32 ? ".float32" : "");
}

// Writes the end of the message about a missing image into `text`. The images that only the repository's
// history has are in the folder of the script that gets them. Empty for other files.
void remedy_for_missing_image(const char* path, char* text, std::size_t size) {
  constexpr char kEnd[] = ".float32.tsm";
  const char* const slash = std::strrchr(path, '/');
  const char* const name = slash == nullptr ? path : slash + 1;
  const std::size_t length = std::strlen(name);
  text[0] = '\0';
  if (length < sizeof kEnd || std::strcmp(name + length - (sizeof kEnd - 1), kEnd) != 0) return;
  char script[FlightOptions::kMaxPath + 16];
  std::snprintf(script, sizeof script, "%.*sfetch_images", static_cast<int>(name - path), path);
  if (access(script, F_OK) != 0) return;
  const int stem_length = static_cast<int>(length - std::strlen(".tsm"));
  std::snprintf(text, size, "; get it with: fsw/models/fetch_images %.*s", stem_length, name);
}

}  // namespace

hal::posix::FileModelStore& open_model(FlightOptions& options) {
  if (options.model_path[0] == '\0') find_shipped_model(options);
  static hal::posix::FileModelStore store(options.model_path, fsw::config::kMaxModelImageBytes);
  return store;
}

bool wants_float32(const FlightOptions& options, hal::ModelStore& store) {
  if (options.numerics_given) return options.float32;
  const hal::ModelBank image = store.bank(0);
  return gnc::is_float32(image.data, image.size);
}

void boot(const FlightOptions& options, AttitudeInitApp& app, const hal::Platform& platform,
          hal::posix::FileModelStore& store) {
  app.init(platform, options.target);
  if (app.boot_status(0) == gnc::ModelStatus::kOk) return;
  const bool unread = store.status() != hal::posix::FileStatus::kOk;
  char remedy[FlightOptions::kMaxPath + 64] = {};
  if (store.status() == hal::posix::FileStatus::kMissing) {
    remedy_for_missing_image(options.model_path, remedy, sizeof remedy);
    if (remedy[0] == '\0' && !options.model_given)
      std::snprintf(remedy, sizeof remedy, "; give --model, or the --target of an image in that folder");
  }
  if (!unread && app.boot_status(0) == gnc::ModelStatus::kBadVersion)
    std::snprintf(remedy, sizeof remedy, "; tumblesight quantize --surface-only renews an earlier one");
  std::fprintf(stderr, "%s: model image %s: %s%s; the mode is SAFE\n", kProgramName, options.model_path,
               unread ? to_string(store.status()) : gnc::to_string(app.boot_status(0)), remedy);
}

}  // namespace tumblesight::fsw::desktop
