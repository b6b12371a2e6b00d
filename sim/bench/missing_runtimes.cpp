// The runtimes that this build does not have.
#include "sim/bench/runtime.hpp"

namespace tumblesight::sim {

#if !TUMBLESIGHT_HAS_ONNX
std::unique_ptr<Runtime> make_onnx_runtime(const Float32Model&, const std::string&, std::string& reason) {
  reason = "built without ONNX: install libonnx-dev and libprotobuf-dev and configure again";
  return nullptr;
}
std::unique_ptr<Runtime> make_onnx_runtime_int8(const FixedPointModel&, const std::string&,
                                                std::string& reason) {
  reason = "built without ONNX: install libonnx-dev and libprotobuf-dev and configure again";
  return nullptr;
}
#endif

#if !TUMBLESIGHT_HAS_ONEDNN
std::unique_ptr<Runtime> make_onednn_int8(const FixedPointModel&, std::string& reason) {
  reason = "built without oneDNN: install libdnnl-dev and configure again";
  return nullptr;
}
#endif

#if !TUMBLESIGHT_HAS_TRAINING
std::unique_ptr<Runtime> make_libtorch(const Float32Model&, std::string& reason) {
  reason = "built without LibTorch: cmake --preset test builds with it";
  return nullptr;
}
#endif

}  // namespace tumblesight::sim
