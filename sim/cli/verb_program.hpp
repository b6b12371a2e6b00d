// The program of a verb, tumblesight-VERB, which `tumblesight` starts.
#pragma once

#include "sim/cli/verbs.hpp"

namespace tumblesight::sim {

// Parses "tumblesight VERB ...", with or without the verb, does its work and returns the exit status.
int run_verb_program(int argc, char** argv, const char* verb, AddCommand& add_command);

// What every program of the tool does first: standard streams that are closed are not given to files, and a
// limit of file sizes is an error of the file, as a full disk is.
void prepare_program();

// Writes what is left of the output. A failure makes a success a failure.
int finish_output(int status);

}  // namespace tumblesight::sim
