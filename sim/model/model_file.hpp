// Model image files in, model image files out.
#pragma once

#include <memory>
#include <string>

#include "gnc/rcnn/model_image.hpp"

namespace tumblesight::sim {

// The end of a message about a model image that does not exist: "; get it with: COMMAND" for the images of
// fsw/models that are in the repository's history only, empty for other files.
std::string remedy_for_missing_image(const std::string& path);

struct Float32Model {
  gnc::ModelHeader header;
  gnc::NetworkWeights<gnc::Float32> weights;
};
// Throws std::runtime_error that names the file and why it is refused.
std::unique_ptr<Float32Model> read_float32_model(const std::string& path);

// Writes beside `path` and renames over; returns the image's CRC. Throws std::runtime_error that names the
// file.
template <class N>
std::uint32_t write_model_file(const std::string& path, const gnc::ModelHeader& header,
                               const gnc::NetworkWeights<N>& weights);

}  // namespace tumblesight::sim
