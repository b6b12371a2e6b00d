#include "gnc/rcnn/network.hpp"

#include "gnc/rcnn/network_flow.hpp"

namespace tumblesight::gnc {

static_assert(DepthImage::kSide == shape::kImageSide);
static_assert(sizeof(Network<FixedPoint>) <= 80 * 1024 + kKernelScratchBytes, "budget of the activations");

namespace {
constexpr auto kNoObserver = [](const char*, const auto&) {};
}  // namespace

template <class N>
void Network<N>::infer_frame(const DepthImage& image, OutputVector<typename N::Real>& out) {
  run_frame<N>(*kernels_, weights_, image, arena_, features_, out, kNoObserver);
}

template <class N>
void Network<N>::infer_sequence(const LstmInput<N>& input, LstmState<N>& state,
                                HeadOutput<typename N::Real>& out) {
  run_sequence<N>(*kernels_, weights_, input, arena_, state, out, kNoObserver);
}

template class Network<FixedPoint>;
#if TUMBLESIGHT_FLOAT32
template class Network<Float32>;
#endif

}  // namespace tumblesight::gnc
