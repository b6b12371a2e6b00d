#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "sim/cli/evaluate_arguments.hpp"
#include "sim/cli/evaluation_output.hpp"
#include "sim/cli/interruptible_experiment.hpp"
#include "sim/evaluation/curves.hpp"
#include "sim/host/interruption.hpp"
#include "sim/host/progress.hpp"
#include "sim/host/text.hpp"
#include "sim/host/write_file.hpp"
#include "sim/report/error_json.hpp"

namespace tumblesight::sim {
namespace {

std::string text_of(const EffectLimit& limit) {
  const std::string range = fmt::format("from {:g} to {:g}: ", limit.from, limit.to);
  if (!limit.holds_at) return range + "at neither end";
  if (!limit.fails_at) return range + "at both ends";
  return range + fmt::format("at {:g}, no longer at {:g}", *limit.holds_at, *limit.fails_at);
}

nlohmann::ordered_json effect_limits_json(const Subject& subject, const ExperimentSettings& settings,
                                          const EffectRow& row, const std::vector<EffectLimit>& limits) {
  nlohmann::ordered_json json{{"effect", row.name},
                              {"unit", row.unit},
                              {"within_20deg_at_least", kEffectBar},
                              {"target", subject.target},
                              {"mesh", subject.mesh_name},
                              {"model", subject.model_name},
                              {"model_crc32", fmt::format("{:08x}", subject.model_crc32)},
                              {"condition", to_string(settings.conditions.front())},
                              {"seed", settings.seed},
                              {"sequences", settings.sequences},
                              {"frames", settings.frames},
                              {"sensor", sensor_json(subject.sensor)},
                              {"ranges_m", {subject.ranges.nearest_m, subject.ranges.farthest_m}},
                              {"other_effects", effect_json(settings.effects)},
                              {"disturbances", disturbances_json(settings.disturbances)}};
  const auto or_null = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
  };
  json["limits"] = nlohmann::ordered_json::array();
  for (const EffectLimit& limit : limits) {
    nlohmann::ordered_json trials = nlohmann::ordered_json::array();
    for (const EffectLimit::Trial& trial : limit.trials)
      trials.push_back({{"strength", trial.strength}, {"within_20deg", trial.within_20deg}});
    json["limits"].push_back({{"from", limit.from},
                              {"to", limit.to},
                              {"holds_at", or_null(limit.holds_at)},
                              {"fails_at", or_null(limit.fails_at)},
                              {"trials", trials}});
  }
  return json;
}

[[noreturn]] void report_interruption() {
  print_message(fmt::format(
      "tumblesight: interrupted by signal {}; what was found of the strengths so far stands above, "
      "no file was written, and the same command begins anew",
      Interruption::signal()));
  throw Exit(128 + Interruption::signal());
}

}  // namespace

void evaluate_effect_limit(const EvaluateArguments& arguments) {
  ExperimentSettings settings = checked_settings(arguments);
  settings.baseline_sequences = 0;
  if (settings.conditions.size() > 1)
    throw ArgumentFault("--effect-limit", "is searched under one --condition");
  const EffectRow& row = effect_named(arguments.effect_limit);
  if (settings.effects.*row.strength != 0.0)
    throw ArgumentFault("--effect-limit",
                        fmt::format("searches the strength of {0}; leave {0} out of --effect", row.name));
  const Subject subject = checked_subject(arguments, settings);
  announce(subject, settings);
  const Interruption interruption;
  const auto limits = effect_limits(row, [&](double strength) {
    ExperimentSettings trial = settings;
    trial.effects.*row.strength = strength;
    ProgressBar bar(fmt::format("{}={:g}", row.name, strength), "steps", steps_of(trial));
    ExperimentFigures figures(subject, trial);
    std::size_t sequences = 0;
    try {
      run_until_signal(subject, trial, figures, sequences, [&](std::uint64_t done) { bar.update(done); });
    } catch (const Interrupted&) {
      bar.finish();
      report_interruption();
    }
    const SubjectResult result = figures.finish();
    bar.finish();
    const double share = result.cells.front().rcnn.within_20deg;
    fmt::print("  {}={:g}: {:.1f} % within 20°\n", row.name, strength, 100.0 * share);
    std::fflush(stdout);
    return share;
  });
  fmt::print("\n  {:g} % within 20°, {}{}{}:\n", 100.0 * kEffectBar, row.name, *row.unit == '\0' ? "" : ", ",
             row.unit);
  for (const EffectLimit& limit : limits) fmt::print("    {}\n", text_of(limit));
  fmt::print("\n");
  if (arguments.files.json.empty()) return;
  write_file(arguments.files.json, effect_limits_json(subject, settings, row, limits).dump(2) + "\n");
}

}  // namespace tumblesight::sim
