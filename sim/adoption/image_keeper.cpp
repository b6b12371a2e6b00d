#include "sim/adoption/image_keeper.hpp"

#include <chrono>
#include <cstdio>
#include <exception>
#include <utility>

#include "sim/host/text.hpp"
#include "sim/surface/target_surface.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kQuickSequences = 20;

}  // namespace

ImageKeeper::ImageKeeper(std::string stem, const TriangleMesh& mesh, double radius_m, ScenarioSettings seen,
                         TargetSymmetry symmetry)
    : stem_(std::move(stem)),
      meshes_{mesh},
      seen_(std::move(seen)),
      surface_(target_surface(mesh, radius_m)),
      symmetry_(std::move(symmetry)) {}

ImageKeeper::~ImageKeeper() {
  if (work_.valid()) work_.wait();
  if (waiting_) begin(std::move(waiting_));
  if (work_.valid()) work_.wait();
}

QuantizationReport ImageKeeper::write_fixed(const Float32Model& model, int sequences) const {
  return quantize_to_file(model, meshes_, sequences, fixed_path(), [](std::uint64_t) {}, seen_,
                          {symmetry_, false, {}, &surface_});
}

bool ImageKeeper::is_busy() const {
  return work_.valid() && work_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

void ImageKeeper::begin(std::shared_ptr<Float32Model> model) {
  work_ = std::async(std::launch::async, [this, kept = std::move(model)] {
    try {
      (void)write_fixed(*kept, kQuickSequences);
    } catch (const std::exception& error) {
      print_message(std::string("\n  warning: no image of the network so far: ") + error.what());
    }
  });
}

void ImageKeeper::keep(std::unique_ptr<Float32Model> model) {
  try {
    write_model_file<gnc::Float32>(float32_path(), model->header, model->weights);
  } catch (const std::exception& error) {
    print_message(std::string("\n  warning: no image of the network so far: ") + error.what());
  }
  waiting_ = std::move(model);
  if (!is_busy()) begin(std::move(waiting_));
}

QuantizationReport ImageKeeper::finish(const Float32Model& model, int sequences) {
  waiting_.reset();
  if (work_.valid()) work_.wait();
  write_model_file<gnc::Float32>(float32_path(), model.header, model.weights);
  return write_fixed(model, sequences);
}

}  // namespace tumblesight::sim
