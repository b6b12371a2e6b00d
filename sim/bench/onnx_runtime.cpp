// ONNX Runtime: in float32 with the models that `tumblesight export` writes, in int8 with the CNN of
// sim/onnx/int8_model.hpp.
#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "sim/bench/onnx_runtime_library.hpp"
#include "sim/bench/runtime.hpp"
#include "sim/model/int8_layers.hpp"
#include "sim/onnx/int8_model.hpp"
#include "sim/onnx/onnx_model.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
namespace {

using Library = OnnxRuntimeLibrary;
using Float32 = gnc::Float32;

// A session with its tensors, which refer to memory of the caller.
class Session {
 public:
  Session(const Library& library, const Library::Handle& environment, const std::string& onnx_model)
      : library_(library), session_(library.make_session(environment, onnx_model)) {}

  template <class Numbers>
  void input(const char* name, Numbers& numbers, const std::vector<std::int64_t>& tensor_shape) {
    input_names_.push_back(name);
    inputs_.push_back(tensor(numbers, tensor_shape));
  }
  template <class Numbers>
  void output(const char* name, Numbers& numbers) {
    output_names_.push_back(name);
    outputs_.push_back(tensor(numbers, row(numbers)));
  }
  template <class Numbers>
  static std::vector<std::int64_t> row(const Numbers& numbers) {
    return {1, static_cast<std::int64_t>(numbers.size())};
  }

  void run() { library_.run(session_, input_names_, inputs_, output_names_, outputs_); }

 private:
  template <class Numbers>
  Library::Object* tensor(Numbers& numbers, const std::vector<std::int64_t>& tensor_shape) {
    tensors_.push_back(library_.make_tensor(numbers.data(), numbers.size(), tensor_shape));
    return tensors_.back().get();
  }

  const Library& library_;
  Library::Handle session_;
  std::vector<Library::Handle> tensors_;
  std::vector<const char*> input_names_, output_names_;
  std::vector<Library::Object*> inputs_, outputs_;
};

struct OnnxModels {
  std::string cnn, recurrent;
};

const std::vector<float>& pixels(const RuntimeImage& image, float) {
  return image.values;
}
const std::vector<std::uint8_t>& pixels(const RuntimeImage& image, std::uint8_t) {
  return image.counts;
}

// Pixel: float, or std::uint8_t for a CNN in int8.
template <class Pixel>
class OnnxRuntime : public Runtime {
 public:
  OnnxRuntime(const OnnxModels& models, std::unique_ptr<Library> library)
      : library_(std::move(library)),
        environment_(library_->make_environment()),
        cnn_(*library_, environment_, models.cnn),
        recurrent_(*library_, environment_, models.recurrent) {
    cnn_.input("image", image_, {1, 1, shape::kImageSide, shape::kImageSide});
    cnn_.output("features", features_);
    cnn_.output("output", out_);
    recurrent_.input("input", input_, Session::row(input_));
    recurrent_.input("h", before_.h, Session::row(before_.h));
    recurrent_.input("c", before_.c, Session::row(before_.c));
    recurrent_.output("output", head_);
    recurrent_.output("h_next", after_.h);
    recurrent_.output("c_next", after_.c);
  }

  std::string name() const override { return "ONNX Runtime " + library_->version(); }
  bool is_int8() const override { return sizeof(Pixel) == 1; }

  void run_frame(const RuntimeImage& image, gnc::Features<Float32>& features,
                 gnc::OutputVector<float>& out) override {
    std::copy_n(pixels(image, Pixel{}).data(), image_.size(), image_.begin());
    cnn_.run();
    features = features_;
    out = out_;
  }

  void run_sequence(const gnc::LstmInput<Float32>& input, gnc::LstmState<Float32>& state,
                    gnc::HeadOutput<float>& out) override {
    input_ = input;
    before_ = state;
    recurrent_.run();
    state = after_;
    out = head_;
  }

 private:
  std::unique_ptr<Library> library_;
  Library::Handle environment_;
  Session cnn_, recurrent_;

  std::array<Pixel, shape::kImageSide * shape::kImageSide> image_{};
  gnc::Features<Float32> features_{};
  gnc::OutputVector<float> out_{};
  gnc::LstmInput<Float32> input_{};
  gnc::LstmState<Float32> before_{}, after_{};
  gnc::HeadOutput<float> head_{};
};

template <class Pixel>
std::unique_ptr<Runtime> make_runtime(const OnnxModels& models, const std::string& library,
                                      std::string& reason) {
  auto found = Library::open(library, reason);
  if (found == nullptr) return nullptr;
  try {
    return std::make_unique<OnnxRuntime<Pixel>>(models, std::move(found));
  } catch (const std::runtime_error& error) {
    reason = error.what();
    return nullptr;
  }
}

}  // namespace

std::unique_ptr<Runtime> make_onnx_runtime(const Float32Model& model, const std::string& library,
                                           std::string& reason) {
  return make_runtime<float>({cnn_as_onnx(model), recurrent_as_onnx(model)}, library, reason);
}

std::unique_ptr<Runtime> make_onnx_runtime_int8(const FixedPointModel& model, const std::string& library,
                                                std::string& reason) {
  const auto recurrent = recurrent_in_float32(model.header, model.weights);
  return make_runtime<std::uint8_t>(
      {int8_cnn_as_onnx(model.header, model.weights), recurrent_as_onnx(*recurrent)}, library, reason);
}

}  // namespace tumblesight::sim
