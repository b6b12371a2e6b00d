#include "sim/adoption/image_keeper.hpp"

#include <chrono>
#include <utility>

#include "sim/quantization/target_surface.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kQuickSequences = 20;

}  // namespace

ImageKeeper::ImageKeeper(std::string stem, const TriangleMesh& mesh, double radius_m, ScenarioSettings seen)
    : stem_(std::move(stem)),
      meshes_{mesh},
      seen_(std::move(seen)),
      surface_(target_surface(mesh, radius_m)) {}

ImageKeeper::~ImageKeeper() {
  if (work_.valid()) work_.wait();
}

QuantizationReport ImageKeeper::write_fixed(const Float32Model& model, int sequences) const {
  return quantize_to_file(model, meshes_, sequences, fixed_path(), [](std::uint64_t) {}, seen_,
                          {{}, false, &surface_});
}

void ImageKeeper::keep(std::unique_ptr<Float32Model> model) {
  write_model_file<gnc::Float32>(float32_path(), model->header, model->weights);
  if (work_.valid()) {
    if (work_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    work_.get();
  }
  work_ = std::async(std::launch::async, [this, kept = std::shared_ptr<Float32Model>(std::move(model))] {
    (void)write_fixed(*kept, kQuickSequences);
  });
}

QuantizationReport ImageKeeper::finish(const Float32Model& model, int sequences) {
  if (work_.valid()) work_.get();
  write_model_file<gnc::Float32>(float32_path(), model.header, model.weights);
  return write_fixed(model, sequences);
}

}  // namespace tumblesight::sim
