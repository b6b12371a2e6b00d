// fault_campaign: prints the counts of outcomes, one line of JSON per place. Run it through
// tests/campaigns/fault/run.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/campaigns/fault/campaign.hpp"

namespace {

using namespace tumblesight::fault;

// `slow`: trials that recovered, but after more than the two cycles that are allowed.
nlohmann::ordered_json summary(const std::string& place, bool with_protections, std::uint64_t seed,
                               std::uint32_t first, const std::vector<Trial>& trials) {
  std::map<std::string, std::uint32_t> outcomes;
  std::uint32_t slow = 0, slowest = 0, changed = 0;
  for (const Trial& trial : trials) {
    ++outcomes[to_string(trial.outcome)];
    changed += trial.changed ? 1U : 0U;
    const bool recovers = trial.outcome == Outcome::kMasked || trial.outcome == Outcome::kRecovered;
    if (recovers && trial.cycles_to_recover > 2) ++slow;
    if (recovers && trial.cycles_to_recover > slowest) slowest = trial.cycles_to_recover;
  }
  return {{"place", place},           {"protected", with_protections}, {"seed", seed},       {"first", first},
          {"count", trials.size()},   {"outcomes", outcomes},          {"changed", changed}, {"slow", slow},
          {"slowest_cycles", slowest}};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App cli("Flips bits in a running application; prints the outcomes, one line of JSON per place");
  std::string model = TUMBLESIGHT_SOURCE_DIR "/fsw/models/near_shoemaker.tsm", target = "near_shoemaker";
  std::uint32_t first = 0, count = 100;
  std::uint64_t seed = 1;
  bool unprotected = false;
  std::map<std::string, Place> places;
  for (int i = 0; i < kPlaces; ++i) places[to_string(static_cast<Place>(i))] = static_cast<Place>(i);
  std::vector<std::string> wanted;
  cli.add_option("--place", wanted, "memory or data to flip bits in; default: all")
      ->check(CLI::IsMember(places));
  cli.add_option("--first", first, "number of the first trial")->capture_default_str();
  cli.add_option("--count", count, "trials per place")->capture_default_str();
  cli.add_option("--seed", seed, "seed of flips and scenario")->capture_default_str();
  cli.add_option("--model", model, "model image")->capture_default_str();
  cli.add_option("--target", target, "target of the model")->capture_default_str();
  cli.add_flag("--unprotected", unprotected, "switch the protections off");
  CLI11_PARSE(cli, argc, argv);
  if (wanted.empty()) {
    for (int i = 0; i < kPlaces; ++i) wanted.emplace_back(to_string(static_cast<Place>(i)));
  }
  try {
    constexpr int kSequences = 20;
    const Flight flight = make_flight(target, model, kSequences, seed);
    for (const std::string& name : wanted) {
      const std::vector<Trial> trials = run_trials(flight, places.at(name), !unprotected, seed, first, count);
      std::printf("%s\n", summary(name, !unprotected, seed, first, trials).dump().c_str());
      std::fflush(stdout);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fault_campaign: %s\n", error.what());
    return 1;
  }
}
