// ImageKeeper: usable model images at any moment of a training. After every validation that beats the last
// one, the network so far is written in float32 and, by a thread of its own, in fixed point.
#pragma once

#include <future>
#include <memory>
#include <string>
#include <vector>

#include "sim/model/model_file.hpp"
#include "sim/quantization/quantize_file.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

class ImageKeeper {
 public:
  // `stem`: path of the images without ".tsm". `seen`: the sequences that calibrate the scales. Makes the
  // surface of the image; throws as target_surface() does. The mesh must outlive this object.
  ImageKeeper(std::string stem, const TriangleMesh& mesh, double radius_m, ScenarioSettings seen,
              TargetSymmetry symmetry);
  ~ImageKeeper();  // writes what is still to be written

  // Writes <stem>.float32.tsm at once, and <stem>.tsm as soon as an earlier one is done. Its scales come from
  // a few sequences, which costs a few hundredths of a degree. A failure is printed: the training goes on.
  void keep(std::unique_ptr<Float32Model> model);
  // Writes both, with scales from so many sequences, and waits for it.
  QuantizationReport finish(const Float32Model& model, int sequences);

  std::string fixed_path() const { return stem_ + ".tsm"; }
  std::string float32_path() const { return stem_ + ".float32.tsm"; }

 private:
  bool is_busy() const;
  void begin(std::shared_ptr<Float32Model> model);
  QuantizationReport write_fixed(const Float32Model& model, int sequences) const;

  std::string stem_;
  std::vector<TriangleMesh> meshes_;
  ScenarioSettings seen_;
  SurfaceSections surface_;
  TargetSymmetry symmetry_;
  std::shared_ptr<Float32Model> waiting_;  // for the image in work
  std::future<void> work_;
};

}  // namespace tumblesight::sim
