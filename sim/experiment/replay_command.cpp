#include "sim/experiment/replay_command.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

// Of `evaluate` alone, or those that the replay sets itself.
constexpr const char* kWithValue[] = {
    "--sequences", "--condition", "--baseline-sequences", "--threads", "--csv",
    "--json",      "--report",    "--effect-limit",       "--shard",   "--shard-file"};
constexpr const char* kFlags[] = {"--curves", "--no-baseline"};

template <std::size_t count>
bool is_in(const char* const (&names)[count], const std::string& name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

}  // namespace

std::string replay_command(const std::string& evaluate_command, Condition condition) {
  std::string command = "tumblesight simulate";
  const std::vector<std::string> words = shell_words(evaluate_command);
  bool is_left_out = false;  // an option, and the values that follow it
  for (std::size_t i = 2; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word.rfind("--", 0) == 0) {
      const std::string name = word.substr(0, word.find('='));
      is_left_out = is_in(kWithValue, name) || is_in(kFlags, name);
    }
    if (!is_left_out) command += " " + shell_word(word);
  }
  return command + " --condition " + to_string(condition) + " --only ";
}

}  // namespace tumblesight::sim
