// For a program that must not outlive the one that has started it, even if that is killed.
#pragma once

#include <string>

namespace tumblesight::sim {

// Holds the process number of the starter.
constexpr char kStarterVariable[] = "TUMBLESIGHT_STARTER";

// "NAME=value" for the environment of a ChildProcess that calls end_with_starter(): this process starts it.
std::string starter_environment();

// Sends this process SIGTERM when its parent ends, and at once if the starter has ended before this call. An
// earlier end is not noticed without kStarterVariable. Call it while SIGTERM still ends the process: a
// handler that is already installed gets the signal, too.
void end_with_starter();

}  // namespace tumblesight::sim
