#include "sim/model/model_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "gnc/rcnn/model_format.hpp"
#include "sim/terminal/write_file.hpp"

namespace tumblesight::sim {
namespace {

using gnc::FixedPoint;
using gnc::Float32;

// Reads the image back as the flight program would.
template <class N>
std::uint32_t checked_crc32(const std::vector<std::uint8_t>& image, const std::string& path) {
  gnc::ModelHeader header;
  const auto weights = std::make_unique<gnc::NetworkWeights<N>>();
  const gnc::ModelStatus status =
      gnc::read_model_image<N>(image.data(), image.size(), nullptr, header, *weights);
  if (status != gnc::ModelStatus::kOk) {
    throw std::runtime_error("model image '" + path +
                             "' is not written, since it would be refused: " + gnc::to_string(status));
  }
  return header.crc32;
}

// Format version 3 of an image in fixed point has one section less and is otherwise the same.
bool is_without_surface(const std::vector<std::uint8_t>& image) {
  using namespace gnc::model_format;
  return image.size() == gnc::kModelImageSize<FixedPoint> - gnc::SurfaceModel::kBytes &&
         std::equal(kMagic.begin(), kMagic.end(), image.begin()) &&
         get_u16(image.data() + kOffsetVersion) == 3 &&
         get_u32(image.data() + kOffsetNumerics) == numerics_of<FixedPoint>() &&
         get_u32(image.data() + kOffsetSectionCount) == gnc::kTensorCount<FixedPoint> &&
         get_u32(image.data() + kOffsetHeaderCrc) == header_crc(image.data(), gnc::kTensorCount<FixedPoint>);
}
static_assert(gnc::model_format::data_offset(gnc::kTensorCount<FixedPoint>) ==
              gnc::kModelDataOffset<FixedPoint>);

// `image`: in fixed point, with or without a surface.
void set_surface(std::vector<std::uint8_t>& image, const std::vector<std::uint8_t>& surface) {
  using namespace gnc::model_format;
  constexpr std::size_t kOffset = gnc::kModelImageSize<FixedPoint> - gnc::SurfaceModel::kBytes;
  constexpr auto kSections = static_cast<std::uint32_t>(gnc::kModelSections<FixedPoint>);
  image.resize(kOffset);
  image.insert(image.end(), surface.begin(), surface.end());
  put_u16(image.data() + kOffsetVersion, gnc::kModelFormatVersion<FixedPoint>);
  put_u32(image.data() + kOffsetTotalSize, static_cast<std::uint32_t>(image.size()));
  put_u32(image.data() + kOffsetSectionCount, kSections);
  std::uint8_t* const entry =
      image.data() + gnc::kModelHeaderSize + (kSections - 1) * gnc::kModelSectionEntrySize;
  put_u32(entry, kSections);
  put_u32(entry + 4, static_cast<std::uint32_t>(kOffset));
  put_u32(entry + 8, static_cast<std::uint32_t>(surface.size()));
  put_u32(entry + 12, gnc::crc32(surface.data(), surface.size()));
  put_u32(image.data() + kOffsetHeaderCrc, header_crc(image.data(), kSections));
}

}  // namespace

std::string remedy_for_missing_image(const std::string& path) {
  const std::filesystem::path image(path);
  const std::string name = image.stem().string();
  const auto ends_with = [&name](const std::string& end) {
    return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
  };
  std::error_code error;
  const bool is_in_history = (ends_with(".float32") || ends_with("_paper_rule")) &&
                             std::filesystem::exists(image.parent_path() / "fetch_images", error);
  return is_in_history ? "; get it with: fsw/models/fetch_images " + name : "";
}

std::string model_stem(std::string path) {
  for (const std::string end : {".tsm", ".float32"}) {
    const bool has = path.size() > end.size() && path.compare(path.size() - end.size(), end.size(), end) == 0;
    if (has) path.resize(path.size() - end.size());
  }
  return path;
}

std::string fault_of_model_path(const std::string& path) {
  std::error_code error;
  const std::string image = "model image '" + path + "' ";
  if (std::filesystem::is_directory(path, error)) return image + "is a folder; give a file";
  if (!std::filesystem::exists(path, error)) return image + "does not exist" + remedy_for_missing_image(path);
  return {};
}

std::vector<std::uint8_t> read_model_bytes(const std::string& path) {
  const std::string fault = fault_of_model_path(path);
  if (!fault.empty()) throw std::runtime_error(fault);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("model image '" + path + "' cannot be read");
  std::vector<std::uint8_t> image{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (is_without_surface(image)) set_surface(image, std::vector<std::uint8_t>(gnc::SurfaceModel::kBytes));
  return image;
}

std::unique_ptr<Float32Model> read_float32_model(const std::string& path) {
  const std::vector<std::uint8_t> bytes = read_model_bytes(path);
  auto model = std::make_unique<Float32Model>();
  const gnc::ModelStatus status =
      gnc::read_model_image<Float32>(bytes.data(), bytes.size(), nullptr, model->header, model->weights);
  if (status == gnc::ModelStatus::kBadNumerics) {
    throw std::runtime_error("model image '" + path +
                             "' is in fixed point; give the one in float32, as `tumblesight train` writes it "
                             "(<target>.float32.tsm)");
  }
  if (status != gnc::ModelStatus::kOk)
    throw std::runtime_error("model image '" + path + "' is refused: " + gnc::to_string(status));
  return model;
}

gnc::ModelHeader read_fixed_point_header(const std::string& path) {
  const std::vector<std::uint8_t> image = read_model_bytes(path);
  gnc::ModelHeader header;
  const auto weights = std::make_unique<gnc::NetworkWeights<FixedPoint>>();
  const gnc::ModelStatus status =
      gnc::read_model_image<FixedPoint>(image.data(), image.size(), nullptr, header, *weights);
  if (status == gnc::ModelStatus::kOk) return header;
  throw std::runtime_error("model image '" + path + "' is refused: " + gnc::to_string(status));
}

template <class N>
std::uint32_t write_model_file(const std::string& path, const gnc::ModelHeader& header,
                               const gnc::NetworkWeights<N>& weights,
                               const std::vector<std::uint8_t>& surface) {
  std::vector<std::uint8_t> bytes(gnc::kModelImageSize<N>);
  bytes.resize(gnc::write_model_image<N>(header, weights, bytes.data(), bytes.size(),
                                         surface.empty() ? nullptr : surface.data()));
  const std::uint32_t crc32 = checked_crc32<N>(bytes, path);
  write_file(path, bytes);
  return crc32;
}
template std::uint32_t write_model_file(const std::string&, const gnc::ModelHeader&,
                                        const gnc::NetworkWeights<Float32>&,
                                        const std::vector<std::uint8_t>&);
template std::uint32_t write_model_file(const std::string&, const gnc::ModelHeader&,
                                        const gnc::NetworkWeights<FixedPoint>&,
                                        const std::vector<std::uint8_t>&);

std::uint32_t write_with_surface(const std::string& from, const std::vector<std::uint8_t>& surface,
                                 const std::string& path) {
  (void)read_fixed_point_header(from);
  std::vector<std::uint8_t> image = read_model_bytes(from);
  set_surface(image, surface);
  const std::uint32_t crc32 = checked_crc32<FixedPoint>(image, path);
  write_file(path, image);
  return crc32;
}

}  // namespace tumblesight::sim
