#include "sim/bench/network_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "gnc/estimation/attitude_estimator.hpp"
#include "gnc/lidar/depth_loops.hpp"
#include "gnc/rcnn/network_flow.hpp"
#include "sim/bench/peak.hpp"

namespace tumblesight::sim {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kRuntimeMeasured_s = 0.6;
constexpr std::size_t kFewestRuns = 30;
// Largest difference allowed, relative to the largest value of an output. In int8 activations behind conv3
// have fewer bits than in fixed point.
constexpr double kSameOutput = 1e-3;
constexpr double kSameInt8Output = 0.1;

double us_between(Clock::time_point begin, Clock::time_point end) {
  return std::chrono::duration<double, std::micro>(end - begin).count();
}

struct Times {
  double median_us;
  double min_us;
};
Times times_of(std::vector<double> us) {
  std::sort(us.begin(), us.end());
  return {us[us.size() / 2], us.front()};
}

// `run(i)` returns the duration of run i in microseconds. Runs for `seconds`, but at least kFewestRuns times.
template <class Run>
Times measured(double seconds, const Run& run) {
  for (std::size_t i = 0; i < 3; ++i) (void)run(i);
  std::vector<double> us;
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  while (us.size() < kFewestRuns || Clock::now() < end) us.push_back(run(us.size()));
  return times_of(std::move(us));
}

template <class Run>
double timed(const Run& run) {
  const Clock::time_point begin = Clock::now();
  run();
  return us_between(begin, Clock::now());
}

template <class N>
double convolution_macs(const gnc::Kernels<N>& kernels) {
  long macs = 0;
  gnc::for_each_index<0, gnc::kImageLayerCount>([&](auto index) {
    constexpr int kIndex = decltype(index)::value;
    const bool averages = !gnc::is_image_layer(gnc::kLayers[kIndex + 1]);
    macs += gnc::Layer<N, kIndex>::macs_done(kernels, averages);
  });
  return static_cast<double>(macs);
}

// One numerics with one instruction set.
template <class N>
class Bench {
 public:
  Bench(const BenchSubject& subject, const gnc::Kernels<N>& kernels)
      : row_s_(subject.row_s),
        frames_(subject.frames),
        kernels_(kernels),
        loops_(gnc::fastest_depth_loops(kernels.set)) {
    const gnc::ModelStatus status = estimator_->load(subject.image.data(), subject.image.size(), nullptr);
    if (status != gnc::ModelStatus::kOk) throw std::runtime_error(gnc::to_string(status));
    estimator_->network().use(kernels);
    for (const gnc::RangeImage& frame : frames_) {
      auto image = std::make_unique<gnc::DepthImage>();
      if (make_image(frame, *image) == gnc::FrameStatus::kOk) images_.push_back(std::move(image));
    }
  }

  std::vector<BenchRow> rows() {
    const Times step = measured(row_s_, [&](std::size_t i) { return step_us(i); });
    const Times depth = measured(row_s_, [&](std::size_t i) {
      gnc::DepthImage& image = *images_[i % images_.size()];
      return timed([&] { (void)make_image(frames_[i % frames_.size()], image); });
    });
    const Times network = measured(row_s_, [&](std::size_t i) { return network_us(i); });
    const Times convolutions = measured(row_s_, [&](std::size_t i) { return convolutions_us(i); });
    return {row("step", step, gnc::kMacCount), row("depth image", depth, 0.0),
            row("network", network, gnc::kMacCount),
            row("convolutions", convolutions, convolution_macs(kernels_),
                measured_peak_macs(kernels_.set, N::kIsInteger))};
  }

 private:
  BenchRow row(const char* name, const Times& times, double macs, std::optional<double> peak = {}) const {
    BenchRow row{name,
                 N::kIsInteger ? "fixed" : "float32",
                 gnc::to_string(kernels_.set),
                 times.median_us,
                 times.min_us,
                 macs,
                 {}};
    if (peak) row.share_of_peak = macs / (1e-6 * times.min_us) / *peak;
    return row;
  }

  gnc::FrameStatus make_image(const gnc::RangeImage& frame, gnc::DepthImage& image) {
    return gnc::make_depth_image(frame, estimator_->model().projection, *scratch_, image, loops_);
  }
  double step_us(std::size_t i) {
    gnc::AttitudeEstimate estimate;
    return timed([&] { (void)estimator_->step(frames_[i % frames_.size()], estimate); });
  }
  double network_us(std::size_t i) {
    gnc::OutputVector<typename N::Real> output;
    gnc::HeadOutput<typename N::Real> head;
    return timed([&] {
      estimator_->network().infer_frame(*images_[i % images_.size()], *activations_, output);
      estimator_->network().infer_sequence(lstm_input_, *activations_, lstm_state_, head);
    });
  }
  // From the depth image in the first layer's input to the last convolution's output.
  double convolutions_us(std::size_t i) {
    Clock::time_point begin, end;
    gnc::OutputVector<typename N::Real> output;
    gnc::run_frame<N>(kernels_, estimator_->network().weights(), *images_[i % images_.size()], *activations_,
                      features_, output, [&](std::string_view name, const auto&) {
                        if (name == gnc::kDepthInput) begin = Clock::now();
                        if (name == gnc::kLayers[gnc::kImageLayerCount - 1].name) end = Clock::now();
                      });
    return us_between(begin, end);
  }

  double row_s_;
  const std::vector<gnc::RangeImage>& frames_;
  const gnc::Kernels<N>& kernels_;
  const gnc::DepthLoops& loops_;
  std::vector<std::unique_ptr<gnc::DepthImage>> images_;
  std::unique_ptr<gnc::AttitudeEstimator<N>> estimator_ = std::make_unique<gnc::AttitudeEstimator<N>>();
  std::unique_ptr<gnc::DepthImageScratch> scratch_ = std::make_unique<gnc::DepthImageScratch>();
  std::unique_ptr<gnc::Activations<N>> activations_ = std::make_unique<gnc::Activations<N>>();
  gnc::Features<N> features_{};
  gnc::LstmInput<N> lstm_input_{};
  gnc::LstmState<N> lstm_state_{};
};

template <class N>
std::vector<BenchRow> bench_sets(const BenchSubject& subject,
                                 const std::function<void(const std::string&)>& started) {
  std::vector<BenchRow> rows;
  for (const gnc::InstructionSet set : gnc::kInstructionSets) {
    const gnc::Kernels<N>* const kernels = gnc::kernels_on<N>(set);
    if (kernels == nullptr) continue;
    started(fmt::format("{}, {}", N::kName, gnc::to_string(set)));
    for (BenchRow& row : Bench<N>(subject, *kernels).rows()) rows.push_back(std::move(row));
  }
  return rows;
}

float to_float(float value) {
  return value;
}
float to_float(std::int16_t value) {
  return static_cast<float>(value);
}
float to_float(gnc::Fixed value) {
  return std::ldexp(static_cast<float>(value.raw()), -gnc::Fixed::kFractionBits);
}

// Largest difference of an output over all frames, relative to its largest value.
class OutputDifference {
 public:
  template <class Ours, class Theirs>
  void add(const Ours& ours, const Theirs& theirs) {
    for (std::size_t i = 0; i < ours.size(); ++i) {
      const double expected = to_float(ours[i]);
      difference_ = std::max(difference_, std::abs(expected - theirs[i]));
      largest_ = std::max(largest_, std::abs(expected));
    }
  }
  double relative() const { return difference_ / largest_; }

 private:
  double difference_ = 0.0, largest_ = 1e-9;
};

// Our network in numerics N and the same in a runtime, on the same frames, each with its own state.
template <class N>
class Comparison {
 public:
  Comparison(Runtime& runtime, const gnc::ModelHeader& header, const gnc::NetworkWeights<N>& weights,
             const std::vector<gnc::RangeImage>& frames)
      : runtime_(runtime), network_(std::make_unique<gnc::Network<N>>()) {
    network_->weights() = weights;
    const auto scratch = std::make_unique<gnc::DepthImageScratch>();
    for (const gnc::RangeImage& frame : frames) {
      auto image = std::make_unique<gnc::DepthImage>();
      if (gnc::make_depth_image(frame, header.projection, *scratch, *image) != gnc::FrameStatus::kOk)
        continue;
      their_images_.emplace_back(*image);
      images_.push_back(std::move(image));
    }
  }

  double largest_difference() {
    gnc::LstmState<N> our_state{};
    gnc::LstmState<gnc::Float32> their_state{};
    OutputDifference of_output, of_features, of_head;
    for (std::size_t i = 0; i < images_.size(); ++i) {
      gnc::OutputVector<typename N::Real> our_output;
      gnc::HeadOutput<typename N::Real> our_head;
      gnc::OutputVector<float> their_output;
      gnc::HeadOutput<float> their_head;
      gnc::Features<gnc::Float32> features;
      network_->infer_frame(*images_[i], *activations_, our_output);
      runtime_.run_frame(their_images_[i], features, their_output);
      of_output.add(our_output, their_output);
      of_features.add(network_->features(), features);
      network_->infer_sequence(lstm_input<N>(features), *activations_, our_state, our_head);
      runtime_.run_sequence(lstm_input<gnc::Float32>(features), their_state, their_head);
      of_head.add(our_head, their_head);
    }
    return std::max({of_output.relative(), of_features.relative(), of_head.relative()});
  }

  double runtime_us(std::size_t i) {
    gnc::OutputVector<float> output;
    gnc::HeadOutput<float> head;
    gnc::Features<gnc::Float32> features;
    return timed([&] {
      runtime_.run_frame(their_images_[i % their_images_.size()], features, output);
      runtime_.run_sequence(lstm_input<gnc::Float32>(features), state_, head);
    });
  }

 private:
  // The features only. The rest of the input comes from algebra that is not part of the network.
  template <class Numerics>
  static gnc::LstmInput<Numerics> lstm_input(const gnc::Features<gnc::Float32>& features) {
    gnc::LstmInput<Numerics> input{};
    for (std::size_t i = 0; i < features.size(); ++i)
      input[i] = static_cast<gnc::DenseInput<Numerics>>(features[i]);
    return input;
  }

  Runtime& runtime_;
  std::unique_ptr<gnc::Network<N>> network_;
  std::unique_ptr<gnc::Activations<N>> activations_ = std::make_unique<gnc::Activations<N>>();
  std::vector<std::unique_ptr<gnc::DepthImage>> images_;
  std::vector<RuntimeImage> their_images_;
  gnc::LstmState<gnc::Float32> state_{};
};

template <class N>
BenchRow bench_with(Runtime& runtime, Comparison<N>& comparison, double limit) {
  const double difference = comparison.largest_difference();
  if (!(difference < limit)) {
    throw std::runtime_error(
        fmt::format("the outputs of {} differ from ours by {:.2g} of the largest output; the limit is {:g}",
                    runtime.name(), difference, limit));
  }
  const Times times = measured(kRuntimeMeasured_s, [&](std::size_t i) { return comparison.runtime_us(i); });
  return {runtime.name(),
          runtime.is_int8() ? "int8" : "float32",
          "",
          times.median_us,
          times.min_us,
          gnc::kMacCount,
          {}};
}

}  // namespace

RuntimeImage::RuntimeImage(const gnc::DepthImage& image) {
  for (const std::uint16_t depth : image.depth) {
    gnc::to_conv_input(depth, values.emplace_back());
    gnc::to_conv_input(depth, counts.emplace_back());
  }
}

std::vector<BenchRow> bench_numerics(const BenchSubject& subject,
                                     const std::function<void(const std::string&)>& started) {
  return gnc::is_float32(subject.image.data(), subject.image.size())
             ? bench_sets<gnc::Float32>(subject, started)
             : bench_sets<gnc::FixedPoint>(subject, started);
}

BenchRow bench_runtime(Runtime& runtime, const Float32Model& model,
                       const std::vector<gnc::RangeImage>& frames) {
  Comparison<gnc::Float32> comparison(runtime, model.header, model.weights, frames);
  return bench_with(runtime, comparison, kSameOutput);
}

BenchRow bench_runtime(Runtime& runtime, const FixedPointModel& model,
                       const std::vector<gnc::RangeImage>& frames) {
  Comparison<gnc::FixedPoint> comparison(runtime, model.header, model.weights, frames);
  return bench_with(runtime, comparison, kSameInt8Output);
}

double largest_difference(Runtime& runtime, const FixedPointModel& model,
                          const std::vector<gnc::RangeImage>& frames) {
  return Comparison<gnc::FixedPoint>(runtime, model.header, model.weights, frames).largest_difference();
}

}  // namespace tumblesight::sim
