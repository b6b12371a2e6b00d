// oneDNN: the CNN in int8, the products of the LSTM and of the recurrent head in float32. The gates'
// sigmoid and tanh are ours.
#include <algorithm>
#include <string>

#include "gnc/nn/lstm.hpp"
#include "sim/bench/onednn_graph.hpp"
#include "sim/bench/runtime.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
namespace {

constexpr int kFoldedSide = shape::kImageSide / 2;

template <class Number>
Number* numbers(const dnnl::memory& memory) {
  return static_cast<Number*>(memory.get_data_handle());
}

// Space to depth, [row][column][channel].
void fold(const std::vector<std::uint8_t>& counts, std::uint8_t* out) {
  for (int y = 0; y < shape::kImageSide; y += 2) {
    const std::uint8_t* const top = counts.data() + y * shape::kImageSide;
    const std::uint8_t* const bottom = top + shape::kImageSide;
    for (int x = 0; x < shape::kImageSide; x += 2, out += 4) {
      out[0] = top[x];
      out[1] = top[x + 1];
      out[2] = bottom[x];
      out[3] = bottom[x + 1];
    }
  }
}

class Onednn : public Runtime {
 public:
  explicit Onednn(const FixedPointModel& model) {
    dnnl::memory value = image_;
    for (const Int8Layer& layer : int8_layers_of(model.weights)) {
      value = is_image_layer(layer.row) ? cnn_.convolution(layer, value) : cnn_.dense(layer, value);
      if (gnc::layer_index(layer.row.name) != gnc::kFeatureLayer) continue;
      features_ = cnn_.readable(value);
      feature_unit_ = layer.output_unit;
    }
    output_ = cnn_.readable(value);
    const auto recurrent = recurrent_in_float32(model.header, model.weights);
    const std::vector<Float32Layer> layers = layers_of(recurrent->weights);
    gates_ = lstm_.gates(layers[gnc::kLstmLayer], input_, hidden_);
    dnnl::memory head = head_input_;
    for (int i = gnc::kLstmLayer + 1; i < gnc::kLayerCount; ++i) head = head_.dense(layers[i], head);
    head_output_ = head;
  }

  std::string name() const override {
    const dnnl_version_t& version = *dnnl::version();
    return "oneDNN " + std::to_string(version.major) + "." + std::to_string(version.minor) + "." +
           std::to_string(version.patch);
  }
  bool is_int8() const override { return true; }

  void run_frame(const RuntimeImage& image, gnc::Features<gnc::Float32>& features,
                 gnc::OutputVector<float>& out) override {
    fold(image.counts, numbers<std::uint8_t>(image_));
    cnn_.run();
    const std::uint8_t* const counts = numbers<std::uint8_t>(features_);
    for (std::size_t i = 0; i < features.size(); ++i)
      features[i] = feature_unit_ * static_cast<float>(counts[i]);
    std::copy_n(numbers<float>(output_), out.size(), out.begin());
  }

  void run_sequence(const gnc::LstmInput<gnc::Float32>& input, gnc::LstmState<gnc::Float32>& state,
                    gnc::HeadOutput<float>& out) override {
    std::copy(input.begin(), input.end(), numbers<float>(input_));
    std::copy(state.h.begin(), state.h.end(), numbers<float>(hidden_));
    lstm_.run();
    gnc::lstm_update(numbers<float>(gates_), nullptr, shape::kLstm, state.h.data(), state.c.data());
    float* const after_hidden = std::copy(state.h.begin(), state.h.end(), numbers<float>(head_input_));
    std::copy(input.begin(), input.end(), after_hidden);
    head_.run();
    std::copy_n(numbers<float>(head_output_), out.size(), out.begin());
  }

 private:
  OnednnGraph cnn_, lstm_, head_;
  dnnl::memory image_ = cnn_.image(kFoldedSide, shape::kSpaceToDepthChannels);
  dnnl::memory input_ = lstm_.vector(shape::kLstmInput), hidden_ = lstm_.vector(shape::kLstm);
  dnnl::memory head_input_ = head_.vector(shape::kLstm + shape::kLstmInput);
  dnnl::memory features_, output_, gates_, head_output_;
  float feature_unit_ = 1.0F;
};

}  // namespace

std::unique_ptr<Runtime> make_onednn_int8(const FixedPointModel& model, std::string& reason) {
  try {
    return std::make_unique<Onednn>(model);
  } catch (const dnnl::error& error) {
    reason = std::string("oneDNN: ") + error.what();
    return nullptr;
  }
}

}  // namespace tumblesight::sim
