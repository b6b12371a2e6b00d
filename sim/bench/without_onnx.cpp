#include "sim/bench/peer.hpp"

namespace tumblesight::sim {

std::unique_ptr<Peer> make_onnx_runtime(const Float32Model&, const std::string&, std::string& reason) {
  reason = "built without ONNX: install libonnx-dev and libprotobuf-dev and configure again";
  return nullptr;
}

}  // namespace tumblesight::sim
