#include "sim/evaluation/replay_command.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>

namespace tumblesight::sim {
namespace {

// Of `evaluate` alone, or those that the replay sets itself.
constexpr const char* kWithValue[] = {
    "--sequences", "--condition", "--baseline-sequences", "--threads", "--csv",
    "--json",      "--report",    "--effect-limit",       "--shard",   "--shard-file"};
constexpr const char* kFlags[] = {"--curves", "--no-baseline", "--peers"};

template <std::size_t count>
bool is_in(const char* const (&names)[count], const std::string& name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

}  // namespace

std::string replay_command(const std::string& evaluate_command, Condition condition) {
  std::istringstream words(evaluate_command);
  std::string command = "tumblesight simulate";
  std::string word;
  words >> word >> word;
  while (words >> word) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, word.rfind("--", 0) == 0 ? equals : std::string::npos);
    if (is_in(kFlags, name)) continue;
    if (!is_in(kWithValue, name)) {
      command += " " + word;
    } else if (name == word) {
      words >> word;
    }
  }
  return command + " --condition " + to_string(condition) + " --only ";
}

}  // namespace tumblesight::sim
