// Model image files: the only place on the ground that reads or writes them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gnc/rcnn/model_image.hpp"

namespace tumblesight::sim {

// The end of a message about a model image that does not exist: "; get it with: COMMAND" for the images of
// fsw/models that are in the repository's history only, empty for other files.
std::string remedy_for_missing_image(const std::string& path);

// The path without ".tsm" and then ".float32": "near" for near.tsm and near.float32.tsm. Another ending
// stays.
std::string model_stem(std::string path);

// Empty for an existing file. Otherwise what is wrong, with that remedy: "model image 'PATH' is a folder".
std::string fault_of_model_path(const std::string& path);

// The bytes of a file, not checked: for the estimators, which check the image themselves and read fixed-point
// weights in place. An image in fixed point of format version 3, which had no surface, comes with one without
// points. Throws std::runtime_error that names the file if it cannot be read.
std::vector<std::uint8_t> read_model_bytes(const std::string& path);

struct Float32Model {
  gnc::ModelHeader header;
  gnc::NetworkWeights<gnc::Float32> weights;
};
// Throws std::runtime_error that names the file and the reason if it cannot be read or is no valid float32
// image.
std::unique_ptr<Float32Model> read_float32_model(const std::string& path);

// The header of an image in fixed point. Throws as read_float32_model does.
gnc::ModelHeader read_fixed_point_header(const std::string& path);

// Writes the file under a temporary name, then renames it. Returns the image's CRC-32. `surface`: in fixed
// point, the target's surface (gnc::SurfaceModel::kBytes); empty: without points. Throws std::runtime_error
// that names the file if it cannot be written, or if the reader would refuse the image.
template <class N>
std::uint32_t write_model_file(const std::string& path, const gnc::ModelHeader& header,
                               const gnc::NetworkWeights<N>& weights,
                               const std::vector<std::uint8_t>& surface = {});

// Writes a copy of the fixed-point image `from` with another surface; all weights stay as they are, byte for
// byte. Throws as write_model_file does, and if `from` is no image in fixed point.
std::uint32_t write_with_surface(const std::string& from, const std::vector<std::uint8_t>& surface,
                                 const std::string& path);

}  // namespace tumblesight::sim
