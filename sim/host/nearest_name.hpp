// The name that a user probably meant by one that is not known.
#pragma once

#include <string>
#include <vector>

namespace tumblesight::sim {

// The known name that takes the fewest changes: a letter more, less or another, or two that changed places.
// Empty if none takes few enough for its length.
std::string nearest_name(const std::string& wrong, const std::vector<std::string>& known);

// "; did you mean 'NAME'?" for the end of a message; nothing if no known name is near.
std::string did_you_mean(const std::string& wrong, const std::vector<std::string>& known);

}  // namespace tumblesight::sim
