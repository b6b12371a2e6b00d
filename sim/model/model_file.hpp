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

// Empty for an existing file that is not larger than an image. Otherwise what is wrong, with that remedy:
// "model image 'PATH' is a folder".
std::string fault_of_model_path(const std::string& path);

// The bytes of a file, not checked: for the estimators, which check the image themselves and read fixed-point
// weights in place. An image in fixed point of an earlier format version comes as one of today's, with zeros
// for the sections that it did not have: points and mesh of the surface (version 3), the mesh (version 4).
// Throws std::runtime_error that names the file if it cannot be read.
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

// The sections of the target's surface in an image in fixed point; empty: not known.
struct SurfaceSections {
  std::vector<std::uint8_t> points;  // gnc::SurfaceModel::kBytes
  std::vector<std::uint8_t> mesh;    // as gnc::SurfaceMesh reads it; zeros behind it may be left out
};

// Writes the file under a temporary name, then renames it. Returns the image's CRC-32. `surface`: not used in
// float32. Throws std::runtime_error that names the file if it cannot be written, or if the reader would
// refuse the image, std::invalid_argument for a section of an impossible size.
template <class N>
std::uint32_t write_model_file(const std::string& path, const gnc::ModelHeader& header,
                               const gnc::NetworkWeights<N>& weights, const SurfaceSections& surface = {});

// Writes a copy of the fixed-point image `from`, in today's format version, with another surface; all weights
// stay as they are, byte for byte. Throws as write_model_file does, and if `from` is no image in fixed point.
std::uint32_t write_with_surface(const std::string& from, const SurfaceSections& surface,
                                 const std::string& path);

}  // namespace tumblesight::sim
