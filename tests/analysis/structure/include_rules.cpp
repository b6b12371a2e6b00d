#include "tests/analysis/structure/include_rules.hpp"

#include <algorithm>
#include <regex>
#include <sstream>

namespace tumblesight::structure {
namespace {

bool starts_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& starts) {
  return std::any_of(starts.begin(), starts.end(),
                     [&](const auto& start) { return starts_with(text, start); });
}

bool is_one_of(const std::string& text, const std::vector<std::string>& all) {
  return std::find(all.begin(), all.end(), text) != all.end();
}

bool is_interface(const std::string& path) {
  return starts_with(path, "hal/") && std::count(path.begin(), path.end(), '/') == 1;
}

// "hal/dds/main.cpp" -> "hal/dds/"
std::string platform_of(const std::string& file) {
  return file.substr(0, file.find('/', 4) + 1);
}

bool is_project(const std::string& path) {
  return starts_with_any(path, {"gnc/", "fsw/", "hal/", "sim/", "tests/"});
}

// What of the standard library needs neither heap, exceptions, I/O nor a clock.
bool is_flight_header(const std::string& path) {
  static const std::vector<std::string> kAllowed{
      "algorithm", "array",  "cmath",   "cstddef",     "cstdint", "cstring", "initializer_list",
      "iterator",  "limits", "numeric", "type_traits", "tuple",   "utility"};
  return is_one_of(path, kAllowed) || starts_with(path, "Eigen/");
}

// A processor's own instructions, and the question whether it has them.
bool is_instruction_header(const std::string& path) {
  return is_one_of(path, {"immintrin.h", "cpuid.h", "arm_neon.h", "arm_acle.h"});
}

// Empty: any project include is fine.
std::string project_objection(const std::string& file, const std::string& path) {
  const auto only = [&](bool allowed, const char* rule) {
    return allowed ? std::string() : std::string(rule);
  };
  if (starts_with(file, "gnc/")) return only(starts_with(path, "gnc/"), "gnc knows gnc only");
  if (starts_with(file, "fsw/programs/")) {
    return only(starts_with_any(path, {"fsw/", "gnc/", "hal/"}), "a flight program knows no ground code");
  }
  if (starts_with(file, "fsw/")) {
    if (starts_with(path, "fsw/programs/")) return "the application knows nothing of its programs";
    return only(starts_with_any(path, {"fsw/", "gnc/"}) || is_interface(path),
                "fsw knows fsw, gnc and the hal interfaces only");
  }
  if (is_interface(file)) {
    return only(starts_with(path, "gnc/") || is_interface(path),
                "a hal interface knows gnc and hal interfaces only");
  }
  if (starts_with(file, "hal/dds/idl/")) {
    return only(starts_with_any(path, {"hal/dds/idl/", "gnc/"}),
                "the interface definition knows gnc and itself only");
  }
  if (starts_with(file, "hal/")) {
    return only(starts_with_any(path, {"gnc/", platform_of(file)}) || is_interface(path),
                "a platform knows gnc, the hal interfaces and itself only");
  }
  if (starts_with(file, "sim/")) {
    return only(starts_with_any(path, {"sim/", "gnc/", "hal/dds/idl/", "hal/replay/recording.hpp"}) ||
                    is_interface(path),
                "sim knows sim, gnc, the hal interfaces, hal/dds/idl and the recording's format only");
  }
  return {};
}

std::string library_objection(const std::string& file, const std::string& path) {
  if (is_instruction_header(path)) {
    const bool knows_processors =
        starts_with_any(file, {"gnc/nn/kernels/", "gnc/numerics/instruction_set", "sim/bench/peak/"});
    return knows_processors ? "" : "only kernels, and what measures them, know a processor's instructions";
  }
  const bool is_flight = starts_with_any(file, {"gnc/", "fsw/"}) && !starts_with(file, "fsw/programs/");
  if ((is_flight || is_interface(file)) && !is_flight_header(path)) {
    return "not a header for the flight side";
  }
  const bool knows_dds = starts_with_any(file, {"hal/dds/", "sim/sil/", "tests/"});
  if (starts_with_any(path, {"dds/", "ddsc/"}) && !knows_dds) return "only hal/dds and sim/sil know DDS";
  return {};
}

}  // namespace

std::vector<Include> includes_of(const std::string& text) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)");
  std::vector<Include> includes;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::smatch match;
    if (std::regex_match(line, match, kInclude)) includes.push_back({number, match[2], match[1] == "\""});
  }
  return includes;
}

std::string objection(const std::string& file, const Include& include) {
  if (is_project(include.path)) return project_objection(file, include.path);
  if (include.quoted && !starts_with_any(file, {"hal/dds/", "sim/", "tests/"}))
    return "not written from the root";
  return library_objection(file, include.path);
}

}  // namespace tumblesight::structure
