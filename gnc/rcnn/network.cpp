#include "gnc/rcnn/network.hpp"

#include "gnc/rcnn/network_flow.hpp"

namespace tumblesight::gnc {

static_assert(DepthImage::kSide == shape::kImageSide);
static_assert(sizeof(Activations<FixedPoint>) + sizeof(Network<FixedPoint>) <=
                  80 * 1024 + kKernelScratchBytes,
              "budget of the activations");

namespace {
constexpr auto kNoObserver = [](const char*, const auto&) {};
}  // namespace

template <class N>
void Network<N>::infer_frame(const DepthImage& image, Activations<N>& activations,
                             OutputVector<typename N::Real>& out) {
  run_frame<N>(*kernels_, weights_, image, activations, features_, out, kNoObserver);
}

template <class N>
void Network<N>::infer_sequence(const LstmInput<N>& input, Activations<N>& activations, LstmState<N>& state,
                                HeadOutput<typename N::Real>& out) {
  run_sequence<N>(*kernels_, weights_, input, activations, state, out, kNoObserver);
}

template class Network<FixedPoint>;
#if TUMBLESIGHT_FLOAT32
template class Network<Float32>;
#endif

}  // namespace tumblesight::gnc
