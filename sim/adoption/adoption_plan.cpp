#include "sim/adoption/adoption_plan.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sim/host/input_file.hpp"
#include "sim/host/write_file.hpp"
#include "sim/json/json_text.hpp"

namespace tumblesight::sim {
namespace {

// None: there is no such file.
std::optional<std::string> text_of(const std::string& path) {
  constexpr InputKind kPlan{"plan of an adoption", 1'000'000};
  try {
    return read_text(path, kPlan);
  } catch (const InputRefused& refusal) {
    if (refusal.is_missing()) return std::nullopt;
    throw;
  }
}

}  // namespace

void write_plan(const std::string& path, const AdoptionPlan& plan) {
  const nlohmann::ordered_json json{{"mission_crc32", plan.mission_crc32},
                                    {"minutes", plan.minutes},
                                    {"seed", plan.seed},
                                    {"start_from", plan.start_from},
                                    {"trainers", plan.trainers},
                                    {"cnn_s", plan.time.cnn_s},
                                    {"rcnn_s", plan.time.rcnn_s},
                                    {"after_s", plan.time.after_s},
                                    {"sequences", plan.time.sequences},
                                    {"calibration_sequences", plan.time.calibration_sequences},
                                    {"elapsed_s", plan.elapsed_s}};
  write_file(path, json.dump(2) + "\n");
}

std::optional<AdoptionPlan> read_plan(const std::string& path, std::uint32_t mission_crc32, double minutes,
                                      std::uint64_t seed) {
  const std::optional<std::string> text = text_of(path);
  if (!text) return std::nullopt;
  AdoptionPlan plan;
  try {
    const nlohmann::json json = parse_json(*text);
    plan.mission_crc32 = json.at("mission_crc32");
    plan.minutes = json.at("minutes");
    plan.seed = json.at("seed");
    plan.start_from = json.at("start_from");
    plan.trainers = json.at("trainers");
    plan.time = {json.at("cnn_s"), json.at("rcnn_s"), json.at("after_s"), json.at("sequences"),
                 json.at("calibration_sequences")};
    plan.elapsed_s = json.at("elapsed_s");
  } catch (const std::exception&) {
    throw std::runtime_error("'" + path +
                             "' is not the plan of an adoption; remove it, or choose another --out");
  }
  const bool same = plan.mission_crc32 == mission_crc32 && plan.minutes == minutes && plan.seed == seed;
  if (same) return plan;
  throw std::runtime_error(fmt::format(
      "'{}' is of an adoption of another mission, or with other --minutes or --seed ({:g} minutes, seed {}); "
      "repeat its command to go on, or choose another --out",
      path, plan.minutes, plan.seed));
}

}  // namespace tumblesight::sim
