// What adds the options of each verb to a command line, and what the verb does after parsing.
#pragma once

#include <string>

#include "sim/cli/command.hpp"

namespace tumblesight::sim {

// The subcommand of a verb of verb_table.hpp, with its summary.
Command add_verb(Command& app, const char* name);

// `command_line`: what the user typed, for reports that name it.
using AddCommand = void(Command& app, const std::string& command_line);
AddCommand add_simulate_command, add_replay_command, add_console_command, add_mesh_command,
    add_evaluate_command, add_merge_command, add_campaign_command, add_quantize_command, add_record_command,
    add_export_command, add_adopt_command, add_train_command, add_bench_command;

}  // namespace tumblesight::sim
