#include "sim/bench/peer.hpp"

namespace tumblesight::sim {

std::unique_ptr<Peer> make_libtorch(const Float32Model&, std::string& reason) {
  reason = "built without LibTorch: cmake --preset test builds with it";
  return nullptr;
}

}  // namespace tumblesight::sim
