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

// The first `folders` folders of a file's path, with the '/' behind them.
std::string first_folders(const std::string& file, int folders) {
  std::size_t end = 0;
  for (int i = 0; i < folders; ++i) end = file.find('/', end) + 1;
  return file.substr(0, end);
}

bool is_project(const std::string& path) {
  return starts_with_any(path, {"gnc/", "fsw/", "hal/", "sim/", "tests/", "cmake/"});
}

// The headers of the standard library that need neither heap, exceptions, I/O nor a clock.
bool is_flight_header(const std::string& path) {
  static const std::vector<std::string> kAllowed{
      "algorithm", "array",  "cmath",   "cstddef",     "cstdint", "cstring", "initializer_list",
      "iterator",  "limits", "numeric", "type_traits", "tuple",   "utility"};
  return is_one_of(path, kAllowed) || starts_with(path, "Eigen/");
}

// Of the C interface: those of C99 without functions, and placement new. check_symbols.cmake finds a heap.
bool is_c_interface_header(const std::string& path) {
  return is_one_of(path, {"stdbool.h", "stddef.h", "stdint.h", "new"});
}

// Intrinsics of a processor, and the header that detects them.
bool is_instruction_header(const std::string& path) {
  return is_one_of(path, {"immintrin.h", "cpuid.h", "arm_neon.h", "arm_acle.h"});
}

// The value types and checksums of gnc that the interfaces and platforms use, and what turns a sensor's rays
// into those of a frame.
bool is_value_type(const std::string& path) {
  return starts_with_any(path, {"gnc/numerics/", "gnc/attitude/"}) || path == "gnc/lidar/range_image.hpp" ||
         path == "gnc/lidar/frame_rays.hpp";
}

struct Verdict {
  bool allowed;
  const char* rule;
};

Verdict verdict_on_fsw(const std::string& file, const std::string& path) {
  if (starts_with(file, "fsw/programs/")) {
    const bool other_program =
        starts_with(path, "fsw/programs/") && !starts_with(path, first_folders(file, 3));
    return {
        starts_with_any(path, {"fsw/", "gnc/", "hal/", "cmake/version.hpp"}) && !other_program &&
            !starts_with(path, "hal/fake/"),
        "a flight program may include fsw, gnc and platforms that fly; no other program and no ground code"};
  }
  if (starts_with(file, "fsw/c/") && starts_with(path, "hal/packets/")) return {true, ""};
  return {(starts_with_any(path, {"fsw/", "gnc/", "hal/messages/"}) || is_interface(path)) &&
              !starts_with(path, "fsw/programs/"),
          "the application may include only itself, gnc, the hal interfaces and messages"};
}

Verdict verdict_on_hal(const std::string& file, const std::string& path) {
  if (starts_with(file, "hal/messages/")) {
    return {starts_with(path, "hal/messages/") || is_value_type(path),
            "messages may include only messages and gnc's value types"};
  }
  if (starts_with(file, "hal/packets/")) {
    return {starts_with_any(path, {"hal/packets/", "hal/messages/", "gnc/numerics/"}),
            "packets may include only packets, messages and gnc's checksums"};
  }
  if (starts_with(file, "hal/dds/idl/")) {
    return {starts_with_any(path, {"hal/dds/idl/", "hal/messages/"}) || is_value_type(path),
            "the wire definition may include only itself, messages and gnc's value types"};
  }
  const bool common = is_interface(path) || starts_with(path, "hal/messages/") || is_value_type(path);
  if (is_interface(file)) {
    return {common, "a hal interface may include only interfaces, messages and gnc's value types"};
  }
  return {common || starts_with(path, "hal/packets/") || starts_with(path, first_folders(file, 2)),
          "a platform may include only itself, the hal interfaces, messages, packets and gnc's value types"};
}

// Empty: the file may include this header of the project.
std::string project_objection(const std::string& file, const std::string& path) {
  Verdict verdict{true, ""};
  if (starts_with(file, "gnc/")) verdict = {starts_with(path, "gnc/"), "gnc may include only gnc"};
  if (starts_with(file, "gnc/rcnn/") && starts_with_any(path, {"gnc/registration/", "gnc/estimation/"}))
    return "the network may know nothing of registration and estimation";
  if (starts_with(file, "fsw/")) verdict = verdict_on_fsw(file, path);
  if (starts_with(file, "hal/")) verdict = verdict_on_hal(file, path);
  if (starts_with(file, "sim/")) {
    verdict = {starts_with_any(path, {"sim/", "gnc/", "hal/messages/", "hal/dds/idl/",
                                      "hal/replay/recording.hpp", "cmake/version.hpp"}),
               "sim may include only sim, gnc, hal/messages, hal/dds/idl and the format of recordings"};
  }
  return verdict.allowed ? std::string() : verdict.rule;
}

std::string library_objection(const std::string& file, const std::string& path) {
  if (is_instruction_header(path)) {
    const bool knows_processors =
        starts_with_any(file, {"gnc/nn/kernels/", "gnc/numerics/instruction_set", "sim/bench/peak/"});
    return knows_processors ? ""
                            : "only the kernels and the benchmark of their peak speed may use intrinsics";
  }
  const bool is_flight = starts_with_any(file, {"gnc/", "fsw/", "hal/messages/", "hal/packets/"}) &&
                         !starts_with(file, "fsw/programs/");
  if (starts_with(file, "fsw/c/") && is_c_interface_header(path)) return {};
  if ((is_flight || is_interface(file)) && !is_flight_header(path)) {
    return "not a header for the flight side";
  }
  // The bridge to ROS 2 has a domain of its own, apart from the bus of the run.
  const bool knows_dds = starts_with_any(
      file, {"hal/dds/", "sim/sil/", "sim/recording/cdr_sample", "sim/console/ros2", "tests/"});
  if (starts_with_any(path, {"dds/", "ddsc/"}) && !knows_dds)
    return "only hal/dds, sim/sil, samples in recordings and the bridge to ROS 2 may include DDS";
  return {};
}

bool is_mission_header(const std::string& path) {
  static const std::regex kHeader(R"((cfe|cfe_tbl_filedef|tumblesight_(app|play)\w*)\.h)");
  return std::regex_match(path, kHeader);
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
  // As in a cFS mission, whose build lists the folders of headers.
  if (include.quoted && starts_with(file, "fsw/programs/cfs/"))
    return is_mission_header(include.path) ? "" : "neither a header of cFE nor of a cFS app";
  if (include.quoted && !starts_with_any(file, {"hal/dds/", "sim/", "tests/"}))
    return "not written from the root";
  return library_objection(file, include.path);
}

void FolderGraph::add(const std::string& file, const Include& include) {
  if (!include.quoted || !is_project(include.path)) return;
  const std::string from = file.substr(0, file.rfind('/'));
  const std::string to = include.path.substr(0, include.path.rfind('/'));
  if (from != to) edges_.try_emplace({from, to}, file + " includes " + include.path);
}

std::vector<std::string> FolderGraph::mutual_pairs() const {
  std::vector<std::string> pairs;
  for (const auto& [edge, example] : edges_) {
    const auto& [from, to] = edge;
    const auto back = edges_.find({to, from});
    if (from < to && back != edges_.end()) {
      pairs.push_back(from + " <-> " + to + ": " + example + "; " + back->second);
    }
  }
  return pairs;
}

}  // namespace tumblesight::structure
