#include "sim/report/palette.hpp"

namespace tumblesight::sim {

const char* colour_of(Condition condition) {
  switch (condition) {
    case Condition::kNominal:
      return kRcnnColour;
    case Condition::kDegraded:
      return "#3fa0a8";
    case Condition::kOccluded:
      return "#b83227";
    case Condition::kTumbling:
      return "#3a8a3f";
    case Condition::kStress:
      return "#7a4fa0";
    case Condition::kOffset:
      return "#b58a1b";
    case Condition::kOutliers:
      return "#5a6069";
  }
  return "#000000";
}

}  // namespace tumblesight::sim
