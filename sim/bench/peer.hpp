// Peer: another runtime with the float32 network, for comparison.
#pragma once

#include <memory>
#include <string>

#include "gnc/rcnn/network.hpp"
#include "sim/model/model_file.hpp"

namespace tumblesight::sim {

class Peer {
 public:
  virtual ~Peer() = default;
  virtual std::string name() const = 0;  // with its version
  // The CNN. `image`: 100 x 100 values, row by row, depth / 65536.
  virtual void run_frame(const float* image, gnc::Features<gnc::Float32>& features,
                         gnc::OutputVector<float>& out) = 0;
  // LSTM and recurrent head. Advances `state` by one frame.
  virtual void run_sequence(const gnc::LstmInput<gnc::Float32>& input, gnc::LstmState<gnc::Float32>& state,
                            gnc::HeadOutput<float>& out) = 0;
};

// Both run on one thread. They return nullptr and set `reason` if the runtime is not available.
// `library`: path of libonnxruntime.so; empty: see OnnxRuntimeLibrary::open().
std::unique_ptr<Peer> make_onnx_runtime(const Float32Model& model, const std::string& library,
                                        std::string& reason);
std::unique_ptr<Peer> make_libtorch(const Float32Model& model, std::string& reason);

}  // namespace tumblesight::sim
