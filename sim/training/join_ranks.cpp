#include "sim/training/join_ranks.hpp"

#include <stdexcept>

#ifdef TUMBLESIGHT_HAS_GLOO
#include "sim/training/gloo_ranks.hpp"
#endif

namespace tumblesight::sim {

#ifdef TUMBLESIGHT_HAS_GLOO
bool can_have_several_ranks() {
  return true;
}
#else
bool can_have_several_ranks() {
  return false;
}
#endif

std::shared_ptr<Ranks> join_ranks(const RankPlace& place, const std::string& folder, double timeout_s) {
  if (place.count == 1) return std::make_shared<Ranks>();
#ifdef TUMBLESIGHT_HAS_GLOO
  return join_gloo_ranks(place, folder, timeout_s);
#else
  static_cast<void>(folder);
  static_cast<void>(timeout_s);
  throw std::runtime_error(
      "several ranks need a build with Gloo: install libgloo-dev, then configure and build again");
#endif
}

}  // namespace tumblesight::sim
