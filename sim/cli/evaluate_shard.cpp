#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "cmake/version.hpp"
#include "sim/campaign/shards.hpp"
#include "sim/cli/evaluate_arguments.hpp"
#include "sim/host/progress.hpp"
#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

void remove(std::string& command, const std::string& option, const std::string& value) {
  for (const char* between : {" ", "="}) {
    const std::string text =
        " " + (*between == '=' ? shell_word(option + "=" + value) : option + " " + shell_word(value));
    if (const std::size_t at = command.find(text); at != std::string::npos) command.erase(at, text.size());
  }
}

// The command that runs all sequences in one process.
std::string command_of_all(const EvaluateArguments& arguments) {
  std::string command = arguments.command_line;
  remove(command, "--shard-file", arguments.shard_file);
  remove(command, "--shard", arguments.shard);
  return command;
}

std::size_t sequences_of(const ExperimentSettings& settings, const Shard& shard) {
  std::size_t sequences = 0;
  for (const ExperimentRun& run : runs_of(settings)) sequences += sequences_of(shard, run.sequences).size();
  return sequences;
}

void require_a_sequence(const Shard& shard, const ExperimentSettings& settings) {
  if (shard.count <= settings.sequences) return;
  throw ArgumentFault(
      "--shard", fmt::format("'{}' are more parts than the {}; give at most as many parts as --sequences",
                             to_string(shard), counted(settings.sequences, "sequence")));
}

// What an earlier run has left.
std::size_t done_in(const ShardWriter& file) {
  std::size_t done = 0;
  for (const auto& run : file.done()) done += run.size();
  return done;
}

void print_dropped(const EvaluateArguments& arguments, const ShardWriter& file) {
  if (file.dropped_bytes() > 0) print_note(dropped_text(arguments.shard_file, file.dropped_bytes()));
}

void run_with_progress(const Subject& subject, const ExperimentSettings& settings, const Shard& shard,
                       ShardWriter& file) {
  const std::uint64_t steps = steps_of(settings, shard);
  const std::uint64_t before = done_in(file) * std::uint64_t{settings.frames};  // for the rate alone
  ProgressBar bar(fmt::format("shard {}", to_string(shard)), "steps", steps, stderr, std::min(before, steps));
  run_shard(subject, settings, shard, file, [&](std::uint64_t done) { bar.update(done); });
  bar.finish();
}

}  // namespace

void evaluate_shard(const EvaluateArguments& arguments) {
  const ExperimentSettings settings = checked_settings(arguments);
  const Shard shard = shard_from(arguments.shard);
  require_a_sequence(shard, settings);
  const Subject subject = checked_subject(arguments, settings);
  if (!arguments.quiet) announce(subject, settings);
  ShardWriter file(arguments.shard_file,
                   {identity_of(subject, settings, kVersion), shard, command_of_all(arguments), kCommit});
  print_dropped(arguments, file);
  if (arguments.quiet) {
    run_shard(subject, settings, shard, file, [](std::uint64_t) {});
    return;
  }
  run_with_progress(subject, settings, shard, file);
  fmt::print("  shard {}            {}, {} of them from before\n  file                 {}\n\n",
             to_string(shard), counted(sequences_of(settings, shard), "sequence"), done_in(file),
             full_path(arguments.shard_file));
}

}  // namespace tumblesight::sim
