#include "sim/training/rank_place.hpp"

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <stdexcept>

namespace tumblesight::sim {
namespace {

constexpr char kLocalRank[] = "TUMBLESIGHT_RANK";
constexpr char kLocalCount[] = "TUMBLESIGHT_RANKS";
constexpr char kLocalStore[] = "TUMBLESIGHT_RANK_STORE";

using Variables = std::function<const char*(const char*)>;

std::string text_of(const Variables& variable, const char* name) {
  const char* text = variable(name);
  return text != nullptr ? text : "";
}

int number_of(const Variables& variable, const char* name, int lowest, int highest) {
  const std::string text = text_of(variable, name);
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < lowest || number > highest) {
    throw std::runtime_error(std::string("environment variable ") + name + "=" + text +
                             ": must be a whole number from " + std::to_string(lowest) + " to " +
                             std::to_string(highest));
  }
  return number;
}

// A launcher's names of the rank and of the number of ranks.
struct Launcher {
  const char* rank;
  const char* count;
};

// The variables of a Slurm step. A batch script has SLURM_PROCID and SLURM_NTASKS, too, but is in no step.
Launcher slurm(const Variables& variable) {
  return {"SLURM_PROCID",
          variable("SLURM_STEP_NUM_TASKS") != nullptr ? "SLURM_STEP_NUM_TASKS" : "SLURM_NTASKS"};
}

std::optional<Launcher> launcher_of(const Variables& variable) {
  constexpr Launcher kLaunchers[] = {
      {kLocalRank, kLocalCount}, {"RANK", "WORLD_SIZE"}, {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}};
  for (const Launcher& launcher : kLaunchers) {
    if (variable(launcher.rank) != nullptr || variable(launcher.count) != nullptr) return launcher;
  }
  const bool in_step = variable("SLURM_STEP_ID") != nullptr || variable("SLURM_STEPID") != nullptr;
  if (in_step && variable("SLURM_PROCID") != nullptr) return slurm(variable);
  return {};
}

void require_both(const Variables& variable, const char* a, const char* b) {
  const char* missing = variable(a) == nullptr ? a : variable(b) == nullptr ? b : nullptr;
  if (missing == nullptr) return;
  throw std::runtime_error(std::string("environment variable ") + (missing == a ? b : a) +
                           " is set, but not " + missing + ": set both, or neither");
}

void add_master(const Variables& variable, RankPlace& place) {
  if (variable("MASTER_ADDR") == nullptr && variable("MASTER_PORT") == nullptr) return;
  require_both(variable, "MASTER_ADDR", "MASTER_PORT");
  place.master_host = text_of(variable, "MASTER_ADDR");
  place.master_port = number_of(variable, "MASTER_PORT", 1, 65535);
  place.launcher_has_store = text_of(variable, "TORCHELASTIC_USE_AGENT_STORE") == "True";
  place.store_prefix = "tumblesight/" + text_of(variable, "TORCHELASTIC_RESTART_COUNT");
}

}  // namespace

RankPlace rank_place(const Variables& variable) {
  constexpr int kMostRanks = 1 << 16;
  RankPlace place;
  const std::optional<Launcher> launcher = launcher_of(variable);
  if (!launcher) return place;
  require_both(variable, launcher->rank, launcher->count);
  place.count = number_of(variable, launcher->count, 1, kMostRanks);
  place.rank = number_of(variable, launcher->rank, 0, place.count - 1);
  if (place.count == 1) return place;
  if (std::strcmp(launcher->rank, kLocalRank) == 0) {
    place.store_file = text_of(variable, kLocalStore);
  } else {
    add_master(variable, place);
  }
  return place;
}

RankPlace rank_place() {
  return rank_place([](const char* name) { return std::getenv(name); });
}

std::vector<std::string> local_rank_environment(int rank, int count, const std::string& store_file) {
  return {std::string(kLocalRank) + "=" + std::to_string(rank),
          std::string(kLocalCount) + "=" + std::to_string(count),
          std::string(kLocalStore) + "=" + store_file};
}

}  // namespace tumblesight::sim
