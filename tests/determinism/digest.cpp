// Prints digests of the estimates of many frames, one line for each numerics and instruction set of this
// build and this processor: numerics, set, number of frames, CRC-32 of the quaternions, expected errors and
// state of every frame.
//   digest FRAMES        with every instruction set
//   digest FRAMES SET    with one instruction set
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "gnc/estimation/attitude_estimator.hpp"
#include "gnc/numerics/crc.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::gnc {
namespace {

constexpr unsigned kSeed = 47;
constexpr int kDifferentFrames =
    37;  // coprime to the length of a sequence, so that no two sequences are the same
constexpr int kSequence = 10;

template <class N>
class Digest {
 public:
  explicit Digest(const Kernels<N>& kernels) : image_(random_model_image<N>(kSeed)) {
    if (estimator_->load(image_.data(), image_.size(), nullptr) != ModelStatus::kOk) std::abort();
    estimator_->network().use(kernels);
  }

  std::uint32_t over(int frames) {
    Crc32 crc;
    for (int i = 0; i < frames; ++i) {
      if (i % kSequence == 0) estimator_->reset();
      AttitudeEstimate estimate;
      const RangeImage frame = random_frame(static_cast<unsigned>(i % kDifferentFrames));
      crc.add_u32(static_cast<std::uint32_t>(estimator_->step(frame, estimate)));
      for (const std::int32_t element : estimate.q_lrf_trf) crc.add_u32(static_cast<std::uint32_t>(element));
      for (const std::int32_t element : estimate.q_lrf_trf_single_frame)
        crc.add_u32(static_cast<std::uint32_t>(element));
      crc.add_u32(estimate.predicted_error_urad);
      crc.add_u32(estimate.predicted_error_single_frame_urad);
      crc.add_u32(estimator_->state_crc32());
    }
    return crc.value();
  }

 private:
  std::vector<std::uint8_t> image_;
  std::unique_ptr<AttitudeEstimator<N>> estimator_ = std::make_unique<AttitudeEstimator<N>>();
};

template <class N>
void print(int frames, const char* only) {
  for (const InstructionSet set : kInstructionSets) {
    const Kernels<N>* const kernels = kernels_on<N>(set);
    if (kernels == nullptr || (only != nullptr && std::strcmp(only, to_string(set)) != 0)) continue;
    std::printf("%s %s %d %08x\n", N::kIsInteger ? "fixed" : "float32", to_string(set), frames,
                static_cast<unsigned>(Digest<N>(*kernels).over(frames)));
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace tumblesight::gnc

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 0;
  if (frames < 1 || frames > 1'000'000) {
    std::fprintf(stderr, "usage: digest FRAMES [INSTRUCTION SET]\n");
    return 2;
  }
  const char* const only = argc > 2 ? argv[2] : nullptr;
  tumblesight::gnc::print<tumblesight::gnc::FixedPoint>(frames, only);
#if TUMBLESIGHT_FLOAT32
  tumblesight::gnc::print<tumblesight::gnc::Float32>(frames, only);
#endif
  return 0;
}
