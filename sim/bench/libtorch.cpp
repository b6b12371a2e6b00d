// LibTorch: the network as TorchScript, frozen and optimized for inference. It runs on one thread if
// it is used by the thread that created it.
#include <torch/script.h>
#include <torch/version.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "sim/bench/runtime.hpp"
#include "sim/model/network_layers.hpp"
#include "sim/training/export_model.hpp"
#include "sim/training/stage.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
namespace {

constexpr int kWarmUps = 10;  // the first runs compile the network

std::string comma_separated(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

// TorchScript of one layer: assigns its output to the variable of its name. Convolutions become oneDNN's. For
// single vectors addmv (OpenBLAS) is faster than linear and than lstm_cell.
std::string convolution_script(const gnc::LayerRow& row) {
  const std::string name = row.name;
  const std::string activated = "torch.relu(torch.conv2d(" + std::string(row.reads[0]) + ", self." + name +
                                "_weight, self." + name + "_bias, [1, 1], [1, 1]))";
  return "    " + name + " = " +
         (row.output == gnc::LayerOutput::kMaxPooled
              ? "torch.max_pool2d(" + activated + ", [2, 2])\n"
              : "torch.flatten(torch.avg_pool2d(" + activated + ", [2, 2]))\n");
}

std::string dense_script(const gnc::LayerRow& row) {
  const std::string name = row.name;
  const std::vector<std::string> reads = reads_of(row);
  const std::string in = reads.size() == 1 ? reads[0] : "torch.cat([" + comma_separated(reads) + "])";
  const std::string sums = "torch.addmv(self." + name + "_bias, self." + name + "_weight, " + in + ")";
  return "    " + name + " = " + (is_hidden(row) ? "torch.relu(" + sums + ")\n" : sums + "\n");
}

std::string lstm_script(const gnc::LayerRow& row) {
  return "    gates = torch.addmv(self.lstm_bias, self.lstm_both, torch.cat([" + std::string(row.reads[0]) +
         ", h]))\n"
         "    take, keep, cell, show = torch.chunk(gates, 4)\n"
         "    c_next = torch.sigmoid(keep) * c + torch.sigmoid(take) * torch.tanh(cell)\n"
         "    " +
         row.name + " = torch.sigmoid(show) * torch.tanh(c_next)\n";
}

std::string layer_script(const gnc::LayerRow& row) {
  switch (row.kind) {
    case gnc::LayerKind::kConvolution:
      return convolution_script(row);
    case gnc::LayerKind::kDense:
      return dense_script(row);
    case gnc::LayerKind::kLstm:
      return lstm_script(row);
  }
  return {};
}

std::string script_of_layers(int first, int end) {
  std::string script;
  for (int i = first; i < end; ++i) script += layer_script(gnc::kLayers[i]);
  return script;
}

std::string cnn_script() {
  return std::string("def forward(self, image):\n    ") + gnc::kDepthInput +
         " = torch.pixel_unshuffle(image, 2)\n" + script_of_layers(0, gnc::kLstmLayer) + "    return " +
         gnc::kLayers[gnc::kFeatureLayer].name + ", " + gnc::kLayers[gnc::kCnnOutputLayer].name + "\n";
}

std::string recurrent_script() {
  return std::string("def forward(self, ") + gnc::kLstmInput + ", h, c):\n" +
         script_of_layers(gnc::kLstmLayer, gnc::kLayerCount) + "    return " +
         gnc::kLayers[gnc::kHeadOutputLayer].name + ", " + gnc::kLayers[gnc::kLstmLayer].name + ", c_next\n";
}

template <std::size_t kCount>
torch::Tensor tensor_of(const std::array<float, kCount>& values) {
  return tensor_of(TensorView{values.data(), values.size()});
}

template <class Numbers>
void copy_to(const c10::IValue& value, Numbers& numbers) {
  std::copy_n(value.toTensor().contiguous().data_ptr<float>(), numbers.size(), numbers.data());
}

// Every tensor under the name <layer>_<part>.
void register_weights(const gnc::NetworkWeights<gnc::Float32>& weights, torch::jit::Module& module) {
  const auto add = [&module](const std::string& name, const torch::Tensor& tensor) {
    module.register_buffer(name, tensor.clone(torch::MemoryFormat::Contiguous));
  };
  for (const Float32Layer& layer : layers_of(weights)) {
    const std::string name = layer.row.name;
    const torch::Tensor weight = weight_from_flight(layer.row, tensor_of(layer.weight));
    add(name + "_weight", weight);
    add(name + "_bias", tensor_of(layer.bias));
    if (layer.recurrent.size == 0) continue;
    const torch::Tensor recurrent = weight_from_flight(layer.row, tensor_of(layer.recurrent));
    add(name + "_both", torch::cat({weight, recurrent}, 1));
  }
}

// Freezing drops the weights that `forward` does not use.
torch::jit::Module optimized(const Float32Model& model, const char* name, const std::string& forward) {
  torch::jit::Module module(name);
  module.register_attribute("training", c10::BoolType::get(), false);
  register_weights(model.weights, module);
  module.define(forward);
  module.eval();
  torch::jit::Module frozen = torch::jit::freeze(module);
  return torch::jit::optimize_for_inference(frozen);
}

class LibTorch : public Runtime {
 public:
  explicit LibTorch(const Float32Model& model)
      : cnn_(optimized(model, "Cnn", cnn_script())),
        recurrent_(optimized(model, "Recurrent", recurrent_script())) {
    const RuntimeImage image{gnc::DepthImage{}};
    gnc::Features<gnc::Float32> features;
    gnc::OutputVector<float> out;
    gnc::LstmState<gnc::Float32> state;
    gnc::HeadOutput<float> head;
    for (int i = 0; i < kWarmUps; ++i) {
      run_frame(image, features, out);
      run_sequence({}, state, head);
    }
  }

  std::string name() const override { return std::string("LibTorch ") + TORCH_VERSION; }

  void run_frame(const RuntimeImage& image, gnc::Features<gnc::Float32>& features,
                 gnc::OutputVector<float>& out) override {
    const c10::InferenceMode no_gradients;
    const torch::Tensor input = torch::from_blob(const_cast<float*>(image.values.data()),
                                                 {1, 1, shape::kImageSide, shape::kImageSide}, torch::kFloat);
    const auto results = cnn_.forward({input}).toTuple();
    copy_to(results->elements()[0], features);
    copy_to(results->elements()[1], out);
  }

  void run_sequence(const gnc::LstmInput<gnc::Float32>& input, gnc::LstmState<gnc::Float32>& state,
                    gnc::HeadOutput<float>& out) override {
    const c10::InferenceMode no_gradients;
    const auto results =
        recurrent_.forward({tensor_of(input), tensor_of(state.h), tensor_of(state.c)}).toTuple();
    copy_to(results->elements()[0], out);
    copy_to(results->elements()[1], state.h);
    copy_to(results->elements()[2], state.c);
  }

 private:
  torch::jit::Module cnn_, recurrent_;
};

}  // namespace

std::unique_ptr<Runtime> make_libtorch(const Float32Model& model, std::string& reason) {
  keep_to_one_thread();
  try {
    return std::make_unique<LibTorch>(model);
  } catch (const c10::Error& error) {
    reason = error.what_without_backtrace();
    return nullptr;
  }
}

}  // namespace tumblesight::sim
