#include "sim/report/picture.hpp"

#include <png.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>

namespace tumblesight::sim {
namespace {

constexpr Rgb kEmptyCell{242, 243, 245};

}  // namespace

Picture depth_picture(const gnc::DepthImage& image) {
  float lowest = 1.0F;
  float highest = 0.0F;
  for (const std::uint16_t depth : image.depth) {
    if (depth == 0) continue;
    const float value = static_cast<float>(depth) / 65536.0F;
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  const float span = std::max(highest - lowest, 1e-3F);
  Picture picture{gnc::DepthImage::kSide, gnc::DepthImage::kSide, {}};
  picture.pixels.reserve(image.depth.size());
  for (const std::uint16_t depth : image.depth) {
    const float value = static_cast<float>(depth) / 65536.0F;
    picture.pixels.push_back(depth > 0 ? sequential_colour((value - lowest) / span) : kEmptyCell);
  }
  return picture;
}

std::vector<std::uint8_t> encode_png(const Picture& picture) {
  const std::size_t expected =
      static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  if (expected == 0 || picture.pixels.size() != expected) {
    throw std::invalid_argument("a picture's pixels must fill its width and height");
  }
  png_image description{};
  description.version = PNG_IMAGE_VERSION;
  description.width = static_cast<png_uint_32>(picture.width);
  description.height = static_cast<png_uint_32>(picture.height);
  description.format = PNG_FORMAT_RGB;

  std::vector<std::uint8_t> bytes(PNG_IMAGE_PNG_SIZE_MAX(description));
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&description, bytes.data(), &size, 0, picture.pixels.data(), 0, nullptr) ==
      0) {
    throw std::runtime_error(std::string("libpng: ") + description.message);
  }
  bytes.resize(size);
  return bytes;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) group = group << 8U | (j < left ? bytes[i + j] : 0U);
    for (std::size_t j = 0; j < 4; ++j) text += j <= left ? kDigits[group >> (18U - 6U * j) & 63U] : '=';
  }
  return text;
}

std::string png_data_uri(const Picture& picture) {
  return "data:image/png;base64," + base64(encode_png(picture));
}

}  // namespace tumblesight::sim
