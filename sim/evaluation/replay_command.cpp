#include "sim/evaluation/replay_command.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

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

// At the spaces outside of quotes.
std::vector<std::string> words_of(const std::string& command) {
  std::vector<std::string> words{""};
  bool is_quoted = false;
  for (const char c : command) {
    if (c == '\'') is_quoted = !is_quoted;
    if (c == ' ' && !is_quoted)
      words.emplace_back();
    else
      words.back() += c;
  }
  return words;
}

}  // namespace

std::string replay_command(const std::string& evaluate_command, Condition condition) {
  std::string command = "tumblesight simulate";
  const std::vector<std::string> words = words_of(evaluate_command);
  for (std::size_t i = 2; i < words.size(); ++i) {
    const std::string& word = words[i];
    const std::string name = word.rfind("--", 0) == 0 ? word.substr(0, word.find('=')) : word;
    if (is_in(kFlags, name)) continue;
    if (!is_in(kWithValue, name)) {
      command += " " + word;
    } else if (name == word) {
      ++i;  // its value
    }
  }
  return command + " --condition " + to_string(condition) + " --only ";
}

}  // namespace tumblesight::sim
