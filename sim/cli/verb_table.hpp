// The verbs of `tumblesight`, in the order in which --help lists them. Each is a program of its own beside
// it, tumblesight-VERB. A build has those whose libraries were there when it was configured, and makes the
// program of a verb when it is asked for it.
#pragma once

#include <string>
#include <vector>

namespace tumblesight::sim {

struct Verb {
  const char* name;
  const char* summary;   // for --help
  const char* packages;  // Debian's, beyond those of every build; nullptr: none
  const char* option;    // of CMake, besides; nullptr: none
};

const std::vector<Verb>& verbs();

// The verb of this name. nullptr: there is none.
const Verb* verb_named(const std::string& name);

// What to do about a verb that a build lacks: "install libcivetweb-dev and configure again".
std::string remedy_for_absent(const Verb& verb);
// About one whose program is not made yet: the command that makes it. `build`: the build's folder.
std::string remedy_for_unbuilt(const Verb& verb, const std::string& build);

// A line for each verb that is absent, for the end of the help. Empty without any.
std::string absent_verbs_text(const std::vector<Verb>& absent);

}  // namespace tumblesight::sim
