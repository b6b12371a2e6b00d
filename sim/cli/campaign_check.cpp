#include "sim/cli/campaign_check.hpp"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "cmake/version.hpp"
#include "sim/campaign/experiment_identity.hpp"
#include "sim/cli/command_line.hpp"
#include "sim/host/nearest_name.hpp"
#include "sim/host/progress.hpp"
#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

std::string joined_words(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += " " + shell_word(word);
  return text;
}

std::string command_of(const OpenCampaign& open, const CampaignTask& task) {
  return "tumblesight evaluate --no-baseline" + joined_words(open.campaign.runs[task.run].options);
}

[[noreturn]] void refuse(const OpenCampaign& open, const CampaignRun& run, const std::string& why) {
  throw std::invalid_argument(
      fmt::format("{}, line {}: run {}: {}", open.campaign.file, run.line, run.name, why));
}

constexpr const char* kRemedy =
    "restore the file, mesh, model or program that it was begun with, or give another --out";

// A file of an earlier version of the campaign must not count as done.
void require_same_experiment(const CampaignTask& task, const ShardHeader& header,
                             const ExperimentIdentity& identity) {
  std::string differs = difference(header.identity, identity);
  if (differs.empty() && to_string(header.shard) != to_string(task.shard))
    differs = fmt::format("shard is {}, not {}", to_string(header.shard), to_string(task.shard));
  if (differs.empty()) return;
  throw std::runtime_error(
      fmt::format("shard file '{}' is of another experiment: {}; {}", task.path, differs, kRemedy));
}

// The report names one command for all sequences of a run.
void require_same_command(const OpenCampaign& open, const CampaignTask& task, const ShardHeader& header) {
  const std::string command = command_of(open, task);
  if (header.command != command)
    throw std::runtime_error(fmt::format("shard file '{}' is of another command: {}, not {}; {}", task.path,
                                         header.command, command, kRemedy));
}

// Nobody would miss what was done with another number of shards.
void require_same_division(const CampaignTask& task) {
  constexpr const char* kMessage =
      "shard file '{}' is of a campaign with other sequences or sequences_per_task, which divide the run "
      "into {} now; restore them, give another --out, or delete the folder of the run";
  if (const std::string other = other_division(task); !other.empty())
    throw std::runtime_error(fmt::format(kMessage, other, counted(task.shard.count, "shard")));
}

// A value that the option does not take, or one that takes more than it looks like; empty: none.
std::string fault_of(const CommandOption& option, const std::string& key,
                     const std::optional<std::string>& value) {
  if (value && option.get_items_expected_max() == 0) return fmt::format("must be true, not '{}'", *value);
  if (!value) return option.get_items_expected_max() > 0 ? "needs a value, not true" : "";
  if (value == "list" && (key == "sensor" || key == "effect"))
    return "'list' shows what there is; name one of them";
  if (option.get_items_expected_min() > 1 && value->find(',') == std::string::npos)
    return fmt::format(
        "a list makes a run for each of its values; write its {} numbers as one text, \"1,2,...\"",
        option.get_items_expected_min());
  return {};
}

std::vector<std::string> long_names_of(const Command& command) {
  std::vector<std::string> names;
  for (const CommandOption option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  return names;
}

// The keys of a run, before their values become a command line in which one may take another for its value.
void require_known_options(const CampaignRun& run) {
  CommandLine line;
  Command& command = line.command();
  EvaluateArguments ignored;
  add_evaluate_options(command, ignored);
  for (const auto& [key, value] : run.keys) {
    if (key == "sequences_per_task")
      throw std::invalid_argument("sequences_per_task is for all runs: write it at the top, before [[run]]");
    const CommandOption option = command.get_option_no_throw("--" + key);
    if (!option || key == "help")
      throw std::invalid_argument(fmt::format(
          "there is no option '{}'; `tumblesight evaluate --help` lists them, write them without dashes{}",
          key, did_you_mean(key, long_names_of(command))));
    if (const std::string fault = fault_of(option, key, value); !fault.empty())
      throw std::invalid_argument(key + ": " + fault);
  }
}

// Against the runs before it. One experiment can be written in several ways.
void require_new(const OpenCampaign& open, std::size_t run,
                 const std::vector<std::optional<ExperimentIdentity>>& identities) {
  for (std::size_t i = 0; i < identities.size(); ++i) {
    if (i == run || !identities[i]) continue;
    const CampaignRun& other = open.campaign.runs[i];
    if (has_same_sequences(*identities[run], *identities[i]))
      throw std::invalid_argument(fmt::format(
          "has the sequences of run {} of line {}, which would count twice; leave out one of them",
          other.name, other.line));
    const SensorDescription &own_sensor = identities[run]->subject.sensor,
                            &other_sensor = identities[i]->subject.sensor;
    if (own_sensor.name == other_sensor.name && crc32_of(own_sensor) != crc32_of(other_sensor))
      throw std::invalid_argument(
          fmt::format("its sensor has the name '{}' and is another one than that of run {} of line {}; give "
                      "one of them another name, in its file",
                      own_sensor.name, other.name, other.line));
  }
}

// Of a run whose options are sound. Its identity, as shard files state it.
ExperimentIdentity identity_of(const EvaluateArguments& arguments) {
  const ExperimentSettings settings = checked_settings(arguments);
  if (runs_of(settings).size() != 1)
    throw std::invalid_argument("it is several evaluations; write the conditions as a list: [\"a\", \"b\"]");
  return identity_of(checked_subject(arguments, settings), settings, kVersion);
}

}  // namespace

EvaluateArguments arguments_of(const OpenCampaign& open, const CampaignTask& task) {
  EvaluateArguments arguments = parsed_evaluate(options_of(open.campaign, task));
  arguments.command_line = command_of(open, task);
  arguments.quiet = true;
  return arguments;
}

void check(const OpenCampaign& open) {
  ProgressBar bar("checking", "runs", open.campaign.runs.size());
  std::vector<std::optional<ExperimentIdentity>> identities(open.campaign.runs.size());
  std::size_t done = 0;
  for (const CampaignTask& task : open.tasks) {
    const CampaignRun& run = open.campaign.runs[task.run];
    std::optional<ExperimentIdentity>& identity = identities[task.run];
    try {
      if (!identity) {
        require_known_options(run);
        require_same_division(task);
        identity = identity_of(arguments_of(open, task));
        require_new(open, task.run, identities);
        bar.update(++done);
      }
      if (const std::optional<ShardHeader> header = header_of(task.path)) {
        require_same_experiment(task, *header, *identity);
        require_same_command(open, task, *header);
      }
    } catch (const std::exception& error) {
      refuse(open, run, error.what());
    }
  }
  bar.finish();
}

void require_same_options(const OpenCampaign& open) {
  for (const CampaignTask& task : open.tasks) {
    try {
      if (const std::optional<ShardHeader> header = header_of(task.path))
        require_same_command(open, task, *header);
    } catch (const std::exception& error) {
      refuse(open, open.campaign.runs[task.run], error.what());
    }
  }
}

}  // namespace tumblesight::sim
