// Pictures for pages: 8-bit RGB images as PNG (libpng) and data URIs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gnc/lidar/depth_image.hpp"
#include "sim/report/colours.hpp"

namespace tumblesight::sim {

struct Picture {
  int width = 0;
  int height = 0;
  std::vector<Rgb> pixels;  // row-major, top row first
};

// Depth in colours of colours.hpp, scaled to the depths that occur in the image. Empty cells are light
// grey.
Picture depth_picture(const gnc::DepthImage& image);

// Throws std::runtime_error when libpng fails, std::invalid_argument when pixels do not match the size.
std::vector<std::uint8_t> encode_png(const Picture& picture);
std::string base64(const std::vector<std::uint8_t>& bytes);
std::string png_data_uri(const Picture& picture);

}  // namespace tumblesight::sim
