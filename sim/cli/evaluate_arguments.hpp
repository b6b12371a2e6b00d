// The arguments of tumblesight evaluate.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/cli/arguments.hpp"
#include "sim/cli/command.hpp"
#include "sim/cli/evaluation_output.hpp"
#include "sim/experiment/experiment.hpp"

namespace tumblesight::sim {

struct EvaluateArguments {
  ScenarioArguments scenario;  // without its condition
  std::vector<std::string> conditions{"nominal"};
  bool sequences_given = false;
  int threads = 0;  // 0: one per core
  bool curves = false;
  std::string effect_limit;  // name of an effect; empty: none
  bool no_baseline = false;
  std::uint32_t baseline_sequences = 100;
  ResultsFiles files;
  std::string shard;       // "3/16"; empty: all sequences
  std::string shard_file;  // of it
  bool paper = false;
  std::string mesh_folder;  // empty: parametric meshes only
  std::string out;          // empty: docs, or out/paper if the number of sequences was given
  std::string command_line;
  bool quiet = false;  // with --shard: no output but errors
};

void add_evaluate_options(Command& command, EvaluateArguments& arguments);
// I/N of --shard.
ValueCheck shard_text();
// What depends on which options were given; after parsing. Throws ArgumentFault.
void complete(const Command& command, EvaluateArguments& arguments);
// From options as they stand on a command line, without the verb. Throws ArgumentFault.
EvaluateArguments parsed_evaluate(const std::vector<std::string>& options);
// Throws ArgumentFault if an option was given that --paper sets itself.
void refuse_options_set_by_paper(const Command& command);
// Throws ArgumentFault if an option of the tables was given, which --effect-limit does not make.
void refuse_options_of_tables(const Command& command);
// Throws ArgumentFault if an option was given with --shard that belongs to the figures of all shards.
void refuse_options_of_merge(const Command& command);

// All settings except the conditions.
ExperimentSettings experiment_settings(const EvaluateArguments& arguments);
// All settings. Throws ArgumentFault or std::invalid_argument if they do not fit together, and as
// require_usable_files() does.
ExperimentSettings checked_settings(const EvaluateArguments& arguments);
// The target of a scenario with its model. Prints the warnings of set_up_target() on the standard error
// stream, and throws as it does.
Subject set_up_subject(const ScenarioArguments& arguments);
// Throws as set_up_subject() does, and if a condition needs an inertia that is not known.
Subject checked_subject(const EvaluateArguments& arguments, const ExperimentSettings& settings);

// --effect-limit: how strong an effect may be.
void evaluate_effect_limit(const EvaluateArguments& arguments);
// --shard: the results of a part of the sequences, to a file.
void evaluate_shard(const EvaluateArguments& arguments);

// --paper: every table and figure of the paper, for every target that has a model. Writes results.md,
// results.csv, results.json and report.html after every subject, so that an interrupted run keeps what it has
// measured.
void evaluate_paper(const EvaluateArguments& arguments);

}  // namespace tumblesight::sim
