// The peer LibTorch: the network as TorchScript, frozen and optimized for inference. It runs on one thread
// where it is used by the thread that made it.
#include <torch/script.h>
#include <torch/version.h>

#include <algorithm>
#include <vector>

#include "sim/bench/peer.hpp"
#include "sim/training/one_thread.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
namespace {

constexpr int kWarmUps = 10;  // the first runs compile

// Convolutions become oneDNN's. Of one vector at a time, addmv (OpenBLAS) is faster than linear, and than
// lstm_cell.
constexpr const char* kCnn = R"(
def forward(self, image):
    x = torch.pixel_unshuffle(image, 2)
    x = torch.max_pool2d(torch.relu(torch.conv2d(x, self.conv1_weight, self.conv1_bias, [1, 1], [1, 1])), [2, 2])
    x = torch.max_pool2d(torch.relu(torch.conv2d(x, self.conv2_weight, self.conv2_bias, [1, 1], [1, 1])), [2, 2])
    x = torch.max_pool2d(torch.relu(torch.conv2d(x, self.conv3_weight, self.conv3_bias, [1, 1], [1, 1])), [2, 2])
    x = torch.relu(torch.conv2d(x, self.conv4_weight, self.conv4_bias, [1, 1], [1, 1]))
    x = torch.flatten(torch.avg_pool2d(x, [2, 2]))
    x = torch.relu(torch.addmv(self.dense1_bias, self.dense1_weight, x))
    features = torch.relu(torch.addmv(self.dense2_bias, self.dense2_weight, x))
    return features, torch.addmv(self.cnn_out_bias, self.cnn_out_weight, features)
)";
constexpr const char* kRecurrent = R"(
def forward(self, input, h, c):
    gates = torch.addmv(self.lstm_bias, self.lstm_both, torch.cat([input, h]))
    take, keep, cell, show = torch.chunk(gates, 4)
    c_next = torch.sigmoid(keep) * c + torch.sigmoid(take) * torch.tanh(cell)
    h_next = torch.sigmoid(show) * torch.tanh(c_next)
    x = torch.relu(torch.addmv(self.head1_bias, self.head1_weight, torch.cat([h_next, input])))
    return torch.addmv(self.head2_bias, self.head2_weight, x), h_next, c_next
)";

template <class Numbers>
torch::Tensor tensor_of(const Numbers& numbers, torch::IntArrayRef sizes) {
  return torch::from_blob(const_cast<float*>(numbers.data()), sizes, torch::kFloat);
}
template <class Numbers>
torch::Tensor vector_of(const Numbers& numbers) {
  return tensor_of(numbers, {static_cast<std::int64_t>(numbers.size())});
}

template <class Numbers>
void copy_to(const c10::IValue& value, Numbers& numbers) {
  std::copy_n(value.toTensor().contiguous().data_ptr<float>(), numbers.size(), numbers.data());
}

// LibTorch's own order of a tensor's numbers: outputs before inputs, images channel by channel.
torch::Tensor arranged(const std::string& layer, const torch::Tensor& weight, std::int64_t outputs) {
  if (layer.rfind("conv", 0) == 0) return weight.view({3, 3, -1, outputs}).permute({3, 2, 0, 1});
  if (layer != "dense1") return weight.view({-1, outputs}).t();
  return weight.view({-1, shape::kConv4, outputs}).permute({2, 1, 0}).flatten(1);
}

// Every tensor under the name <layer>_<part>.
void register_weights(const gnc::NetworkWeights<gnc::Float32>& weights, torch::jit::Module& module) {
  gnc::for_each_layer(weights, [&module](const char* layer_name, const auto& layer) {
    const auto outputs = static_cast<std::int64_t>(layer.bias.size());
    gnc::for_each_tensor_of(layer_name, layer, [&](const char*, const std::string& part, const auto& tensor) {
      const torch::Tensor flat = vector_of(tensor);
      const torch::Tensor own = part == "bias" ? flat : arranged(layer_name, flat, outputs);
      module.register_buffer(std::string(layer_name) + "_" + part,
                             own.clone(torch::MemoryFormat::Contiguous));
    });
  });
  module.register_buffer(
      "lstm_both",
      torch::cat({module.attr("lstm_weight").toTensor(), module.attr("lstm_recurrent").toTensor()}, 1));
}

// What `forward` does not use, freezing drops.
torch::jit::Module optimized(const Float32Model& model, const char* name, const char* forward) {
  torch::jit::Module module(name);
  module.register_attribute("training", c10::BoolType::get(), false);
  register_weights(model.weights, module);
  module.define(forward);
  module.eval();
  torch::jit::Module frozen = torch::jit::freeze(module);
  return torch::jit::optimize_for_inference(frozen);
}

class LibTorch : public Peer {
 public:
  explicit LibTorch(const Float32Model& model)
      : cnn_(optimized(model, "Cnn", kCnn)), recurrent_(optimized(model, "Recurrent", kRecurrent)) {
    const std::vector<float> image(shape::kImageSide * shape::kImageSide);
    gnc::Features<gnc::Float32> features;
    gnc::OutputVector<float> out;
    gnc::LstmState<gnc::Float32> state;
    gnc::HeadOutput<float> head;
    for (int i = 0; i < kWarmUps; ++i) {
      run_frame(image.data(), features, out);
      run_sequence({}, state, head);
    }
  }

  std::string name() const override { return std::string("LibTorch ") + TORCH_VERSION; }

  void run_frame(const float* image, gnc::Features<gnc::Float32>& features,
                 gnc::OutputVector<float>& out) override {
    const c10::InferenceMode no_gradients;
    const torch::Tensor input = torch::from_blob(const_cast<float*>(image),
                                                 {1, 1, shape::kImageSide, shape::kImageSide}, torch::kFloat);
    const auto results = cnn_.forward({input}).toTuple();
    copy_to(results->elements()[0], features);
    copy_to(results->elements()[1], out);
  }

  void run_sequence(const gnc::LstmInput<gnc::Float32>& input, gnc::LstmState<gnc::Float32>& state,
                    gnc::HeadOutput<float>& out) override {
    const c10::InferenceMode no_gradients;
    const auto results =
        recurrent_.forward({vector_of(input), vector_of(state.h), vector_of(state.c)}).toTuple();
    copy_to(results->elements()[0], out);
    copy_to(results->elements()[1], state.h);
    copy_to(results->elements()[2], state.c);
  }

 private:
  torch::jit::Module cnn_, recurrent_;
};

}  // namespace

std::unique_ptr<Peer> make_libtorch(const Float32Model& model, std::string& reason) {
  keep_to_one_thread();
  try {
    return std::make_unique<LibTorch>(model);
  } catch (const c10::Error& error) {
    reason = error.what_without_backtrace();
    return nullptr;
  }
}

}  // namespace tumblesight::sim
