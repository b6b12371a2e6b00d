#include "sim/bench/network_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "gnc/lidar/depth_loops.hpp"
#include "gnc/rcnn/attitude_estimator.hpp"
#include "gnc/rcnn/network_flow.hpp"
#include "sim/bench/peak.hpp"

namespace tumblesight::sim {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kPeerMeasured_s = 0.6;
constexpr std::size_t kFewestRuns = 30;
constexpr double kSameOutput = 1e-3;  // largest difference allowed, relative to the largest output

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
  gnc::for_each_index<0, gnc::kImageLayerCount>(
      [&](auto index) { macs += gnc::Layer<N, decltype(index)::value>::macs_done(kernels.pixels); });
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
      estimator_->network().infer_frame(*images_[i % images_.size()], output);
      estimator_->network().infer_sequence(lstm_input_, lstm_state_, head);
    });
  }
  // From the depth image in the first layer's input to the last convolution's output.
  double convolutions_us(std::size_t i) {
    Clock::time_point begin, end;
    gnc::OutputVector<typename N::Real> output;
    gnc::run_frame<N>(kernels_, estimator_->network().weights(), *images_[i % images_.size()], *arena_,
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
  std::unique_ptr<gnc::Arena<N>> arena_ = std::make_unique<gnc::Arena<N>>();
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

// Our network and a peer's on the same frames, each with its own state.
class Comparison {
 public:
  Comparison(Peer& peer, const Float32Model& model, const std::vector<gnc::RangeImage>& frames)
      : peer_(peer), network_(std::make_unique<gnc::Network<gnc::Float32>>()) {
    network_->weights() = model.weights;
    const auto scratch = std::make_unique<gnc::DepthImageScratch>();
    for (const gnc::RangeImage& frame : frames) {
      auto image = std::make_unique<gnc::DepthImage>();
      if (gnc::make_depth_image(frame, model.header.projection, *scratch, *image) != gnc::FrameStatus::kOk)
        continue;
      pixels_.emplace_back(image->depth.begin(), image->depth.end());
      for (float& pixel : pixels_.back()) pixel /= 65536.0F;
      images_.push_back(std::move(image));
    }
  }

  // Largest difference relative to the largest output.
  double largest_difference() {
    gnc::LstmState<gnc::Float32> our_state{}, their_state{};
    double difference = 0.0, largest = 1e-9;
    const auto compare = [&](const auto& ours, const auto& theirs) {
      for (std::size_t i = 0; i < ours.size(); ++i) {
        difference = std::max(difference, std::abs(static_cast<double>(ours[i]) - theirs[i]));
        largest = std::max(largest, std::abs(static_cast<double>(ours[i])));
      }
    };
    for (std::size_t i = 0; i < images_.size(); ++i) {
      gnc::OutputVector<float> our_output, their_output;
      gnc::HeadOutput<float> our_head, their_head;
      gnc::Features<gnc::Float32> features;
      network_->infer_frame(*images_[i], our_output);
      peer_.run_frame(pixels_[i].data(), features, their_output);
      compare(our_output, their_output);
      compare(network_->features(), features);
      const gnc::LstmInput<gnc::Float32> input = lstm_input(features);
      network_->infer_sequence(input, our_state, our_head);
      peer_.run_sequence(input, their_state, their_head);
      compare(our_head, their_head);
    }
    return difference / largest;
  }

  double peer_us(std::size_t i) {
    gnc::OutputVector<float> output;
    gnc::HeadOutput<float> head;
    gnc::Features<gnc::Float32> features;
    return timed([&] {
      peer_.run_frame(pixels_[i % pixels_.size()].data(), features, output);
      peer_.run_sequence(lstm_input(features), state_, head);
    });
  }

 private:
  // The features only. The rest of the input comes from algebra that is not part of the network.
  static gnc::LstmInput<gnc::Float32> lstm_input(const gnc::Features<gnc::Float32>& features) {
    gnc::LstmInput<gnc::Float32> input{};
    std::copy(features.begin(), features.end(), input.begin());
    return input;
  }

  Peer& peer_;
  std::unique_ptr<gnc::Network<gnc::Float32>> network_;
  std::vector<std::unique_ptr<gnc::DepthImage>> images_;
  std::vector<std::vector<float>> pixels_;
  gnc::LstmState<gnc::Float32> state_{};
};

}  // namespace

std::vector<BenchRow> bench_numerics(const BenchSubject& subject,
                                     const std::function<void(const std::string&)>& started) {
  return gnc::is_float32(subject.image.data(), subject.image.size())
             ? bench_sets<gnc::Float32>(subject, started)
             : bench_sets<gnc::FixedPoint>(subject, started);
}

BenchRow bench_peer(Peer& peer, const Float32Model& model, const std::vector<gnc::RangeImage>& frames) {
  Comparison comparison(peer, model, frames);
  const double difference = comparison.largest_difference();
  if (!(difference < kSameOutput)) {
    throw std::runtime_error(
        fmt::format("the outputs of {} differ from ours by {:.2g} of the largest output; the limit is {:g}",
                    peer.name(), difference, kSameOutput));
  }
  const Times times = measured(kPeerMeasured_s, [&](std::size_t i) { return comparison.peer_us(i); });
  return {peer.name(), "float32", "", times.median_us, times.min_us, gnc::kMacCount, {}};
}

}  // namespace tumblesight::sim
