// Peer: another runtime that carries the float32 network, to be measured beside ours.
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
  // The CNN: `image` is 100 x 100, row by row.
  virtual void run_frame(const float* image, gnc::Features<gnc::Float32>& features,
                         gnc::OutputVector<float>& out) = 0;
  // LSTM and recurrent head; `state` is advanced.
  virtual void run_sequence(const gnc::LstmInput<gnc::Float32>& input, gnc::LstmState<gnc::Float32>& state,
                            gnc::HeadOutput<float>& out) = 0;
};

// Both run on one thread. nullptr, and why not in `reason`, where the runtime is not there.
// `library`: libonnxruntime.so; empty: the one of npm's onnxruntime-node in build/node_modules, or the
// system's.
std::unique_ptr<Peer> make_onnx_runtime(const Float32Model& model, const std::string& library,
                                        std::string& reason);
std::unique_ptr<Peer> make_libtorch(const Float32Model& model, std::string& reason);

}  // namespace tumblesight::sim
