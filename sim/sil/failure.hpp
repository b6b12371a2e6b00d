// SilFailure: the reason why a run cannot continue, as a message for the user.
#pragma once

#include <stdexcept>

namespace tumblesight::sim {

class SilFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace tumblesight::sim
