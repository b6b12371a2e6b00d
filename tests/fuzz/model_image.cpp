// The reader of model images, and for some inputs a step with the accepted model. Compiled once for each
// numerics, which TUMBLESIGHT_NUMERICS names.
#include <cstring>
#include <memory>

#include "gnc/estimation/attitude_estimator.hpp"
#include "tests/fuzz/check_estimate.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/fuzz/patched_image.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::fuzz {
namespace {

// The kernels that an input asks for, or the next faster ones available. In the portable ones (0)
// UndefinedBehaviorSanitizer checks every sum.
template <class N>
const gnc::Kernels<N>& kernels_by(std::uint8_t number) {
  for (std::size_t i = number % gnc::kInstructionSets.size(); i < gnc::kInstructionSets.size(); ++i) {
    const gnc::Kernels<N>* const found = gnc::kernels_on<N>(gnc::kInstructionSets[i]);
    if (found != nullptr) return *found;
  }
  return gnc::fastest_kernels<N>();
}

template <class N>
class ModelImageTarget {
 public:
  ModelImageTarget() {
    const bool is_good =
        estimator_->load(image_.data(), gnc::kModelImageSize<N>, nullptr) == gnc::ModelStatus::kOk;
    require(is_good, "the image without patches is accepted");
  }

  void run(Input input) {
    const bool reads_values = is_chosen(input, kReadsValues);
    const bool steps = is_chosen(input, kSteps);
    const std::uint8_t choice = input.u8();
    const char* const target = (choice & 1) != 0 ? "test_craft" : nullptr;
    const std::uint32_t frames = (choice & 2) != 0 ? 2 : 1;
    estimator_->network().use(kernels_by<N>(choice >> 2));
    const std::size_t size = image_.apply(input, reads_values);
    const std::uint32_t before = estimator_->model().crc32;
    const gnc::ModelStatus status = estimator_->load(image_.data(), size, target);
    require(estimator_->has_model(), "there is a model");
    if (status == gnc::ModelStatus::kOk) {
      check_model(target);
      check_mesh();
      if (steps) step(frames);
    } else {
      require(estimator_->model().crc32 == before, "a refused image leaves the earlier model in use");
    }
    image_.undo();
  }

 private:
  // One input in kReadsValues has its values read; one in kSteps, a multiple, also makes a step.
  static constexpr std::uint32_t kReadsValues = 256, kSteps = 2048;

  void check_model(const char* target) {
    const gnc::ModelHeader& header = estimator_->model();
    require(gnc::is_possible(header.projection), "an accepted depth projection is possible");
    require(std::memchr(header.target.data(), '\0', header.target.size()) != nullptr,
            "a target's name is NUL-terminated");
    require(target == nullptr || std::strcmp(header.target.data(), target) == 0,
            "the target is the expected one");
  }

  void check_mesh() {
    const gnc::SurfaceMesh& mesh = estimator_->mesh();
    const auto exists = [&mesh](std::uint16_t vertex) { return vertex < mesh.vertices(); };
    for (int i = 0; i < mesh.triangles(); ++i) {
      for (const std::uint16_t corner : mesh.triangle(i))
        require(exists(corner), "a triangle's corner exists");
    }
    for (int i = 0; i < mesh.edges(); ++i) {
      const gnc::SurfaceMesh::Edge edge = mesh.edge(i);
      require(exists(edge.first) && exists(edge.second), "an edge's ends exist");
      for (const std::uint16_t corner : edge.opposite)
        require(exists(corner), "a corner beside an edge exists");
    }
  }

  // The first frame of a track and, with two frames, one that continues it.
  void step(std::uint32_t frames) {
    for (std::uint32_t i = 1; i <= frames; ++i) {
      gnc::AttitudeEstimate estimate;
      require(estimator_->step(frame_, estimate) == gnc::FrameStatus::kOk, "a good frame is used");
      // Fewer if the weights left no attitude to continue from.
      require(estimate.frames_since_reset >= 1 && estimate.frames_since_reset <= i, "frames are counted");
      check_estimate(estimate);
    }
  }

  PatchedImage image_{gnc::random_model_image<N>(1)};
  gnc::RangeImage frame_ = gnc::random_frame(1);
  std::unique_ptr<gnc::AttitudeEstimator<N>> estimator_ = std::make_unique<gnc::AttitudeEstimator<N>>();
};

}  // namespace
}  // namespace tumblesight::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  static fuzz::ModelImageTarget<gnc::TUMBLESIGHT_NUMERICS> target;
  target.run(fuzz::Input(data, size));
  return 0;
}
