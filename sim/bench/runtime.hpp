// Runtime: another program that runs networks, with ours in float32 or int8, for comparison.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gnc/rcnn/network.hpp"
#include "sim/model/model_file.hpp"

namespace tumblesight::sim {

// A depth image of 100 x 100 values, row by row, as either network takes it.
struct RuntimeImage {
  explicit RuntimeImage(const gnc::DepthImage& image);
  std::vector<float> values;         // depth / 65536
  std::vector<std::uint8_t> counts;  // depth / 256, rounded
};

// The features are real numbers in float32, and in int8 the fixed-point network's counts. All else is in real
// numbers.
class Runtime {
 public:
  virtual ~Runtime() = default;
  virtual std::string name() const = 0;  // with its version
  virtual bool is_int8() const { return false; }
  // The CNN.
  virtual void run_frame(const RuntimeImage& image, gnc::Features<gnc::Float32>& features,
                         gnc::OutputVector<float>& out) = 0;
  // LSTM and recurrent head. Advances `state` by one frame. `input` is in the unit of the features.
  virtual void run_sequence(const gnc::LstmInput<gnc::Float32>& input, gnc::LstmState<gnc::Float32>& state,
                            gnc::HeadOutput<float>& out) = 0;
};

// Its weights are read from the model image, which must outlive it.
struct FixedPointModel {
  gnc::ModelHeader header;
  gnc::NetworkWeights<gnc::FixedPoint> weights;
};

// All run on one thread. They return nullptr and set `reason` if the runtime is not available.
// `library`: path of libonnxruntime.so; empty: see OnnxRuntimeLibrary::open().
std::unique_ptr<Runtime> make_onnx_runtime(const Float32Model& model, const std::string& library,
                                           std::string& reason);
std::unique_ptr<Runtime> make_onnx_runtime_int8(const FixedPointModel& model, const std::string& library,
                                                std::string& reason);
std::unique_ptr<Runtime> make_onednn_int8(const FixedPointModel& model, std::string& reason);
std::unique_ptr<Runtime> make_libtorch(const Float32Model& model, std::string& reason);

}  // namespace tumblesight::sim
