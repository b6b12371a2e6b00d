#include "sim/cli/subject_setup.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "sim/cli/target_setup.hpp"

namespace tumblesight::sim {

Subject set_up_subject(const ScenarioArguments& arguments) {
  TargetSetup setup = set_up_target(arguments);
  for (const std::string& warning : setup.warnings) fmt::print(stderr, "  note: {}\n", warning);
  Subject subject;
  subject.target = arguments.target;
  subject.mesh_name = setup.mesh_name;
  subject.mesh = std::move(setup.mesh);
  subject.swath_m = 1e-3 * setup.projection.swath_mm;
  subject.model_name = std::filesystem::path(setup.model_path).stem().string();
  subject.model_crc32 = setup.header.crc32;
  subject.model = std::move(setup.model);
  subject.inertia_kg_m2 = setup.inertia_kg_m2;
  return subject;
}

}  // namespace tumblesight::sim
