// The verbs that a build without their libraries lacks, and how to get them.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace tumblesight::sim {

// "this build has no console: install libcivetweb-dev and configure again". Empty if `app` has the verb, or
// no build has it.
std::string fault_of_absent_verb(const CLI::App& app, const std::string& verb);

// A line for each verb that `app` lacks, for the end of its help. Empty if it has all.
std::string absent_verbs_text(const CLI::App& app);

}  // namespace tumblesight::sim
