#include "sim/cli/version_text.hpp"

#include <fmt/format.h>

#include "cmake/version.hpp"
#include "gnc/rcnn/model_format.hpp"
#include "hal/dds/idl/icd_hash.hpp"

namespace tumblesight::sim {

std::string version_text() {
  return fmt::format("tumblesight {}\ncommit {}\nmodel format {}\ninterface {:08x}", kVersion, kCommit,
                     gnc::kModelFormatVersion<gnc::FixedPoint>, hal::dds::icd_hash());
}

}  // namespace tumblesight::sim
