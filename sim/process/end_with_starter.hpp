// For a program that must not outlive the one that has started it, even if that is killed.
#pragma once

#include <string>

namespace tumblesight::sim {

// "NAME=value" for the environment of a ChildProcess that calls end_with_starter(): this process starts it.
std::string starter_environment();

// Sends this process SIGTERM when its parent ends, and at once if it has ended before this call. Whether it
// has is certain with starter_environment(); without it the parent counts as ended if process 1 has adopted
// us.
void end_with_starter();

}  // namespace tumblesight::sim
