#include "sim/model/model_file.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "gnc/rcnn/model_format.hpp"
#include "sim/host/input_file.hpp"
#include "sim/host/write_file.hpp"

namespace tumblesight::sim {
namespace {

using gnc::FixedPoint;
using gnc::Float32;

constexpr InputKind kModelImage{"model image",
                                std::max(gnc::kModelImageSize<FixedPoint>, gnc::kModelImageSize<Float32>)};

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

constexpr std::size_t kPointsOffset = gnc::kModelDataOffset<FixedPoint> + gnc::kWeightBytes<FixedPoint>;
constexpr std::uint32_t kTensors = gnc::kTensorCount<FixedPoint>;

// The format versions in fixed point before today's have fewer sections and are otherwise the same.
struct FormerFormat {
  std::uint16_t version;
  std::uint32_t sections;
  std::size_t size_bytes;
};
constexpr FormerFormat kFormerFormats[] = {
    {3, kTensors, kPointsOffset},
    {4, kTensors + 1, kPointsOffset + gnc::SurfaceModel::kBytes},
};
static_assert(gnc::model_format::data_offset(kTensors) == gnc::kModelDataOffset<FixedPoint>);
static_assert(gnc::model_format::data_offset(kTensors + 1) == gnc::kModelDataOffset<FixedPoint>);

// `image` is complete and its header intact. The damage in a section is found later, by the section's CRC-32.
bool has_format(const std::vector<std::uint8_t>& image, const FormerFormat& format) {
  using namespace gnc::model_format;
  return image.size() == format.size_bytes && std::equal(kMagic.begin(), kMagic.end(), image.begin()) &&
         get_u16(image.data() + kOffsetVersion) == format.version &&
         get_u32(image.data() + kOffsetNumerics) == numerics_of<FixedPoint>() &&
         get_u32(image.data() + kOffsetSectionCount) == format.sections &&
         get_u32(image.data() + kOffsetHeaderCrc) == header_crc(image.data(), format.sections);
}

// `sections`: in the image so far.
void append_section(std::vector<std::uint8_t>& image, std::uint32_t sections,
                    const std::vector<std::uint8_t>& section) {
  using namespace gnc::model_format;
  std::uint8_t* const entry = image.data() + gnc::kModelHeaderSize + sections * gnc::kModelSectionEntrySize;
  put_u32(entry, sections + 1);
  put_u32(entry + 4, static_cast<std::uint32_t>(image.size()));
  put_u32(entry + 8, static_cast<std::uint32_t>(section.size()));
  put_u32(entry + 12, gnc::crc32(section.data(), section.size()));
  image.insert(image.end(), section.begin(), section.end());
}

// Header and CRC-32 of an image that has all sections.
void complete_header(std::vector<std::uint8_t>& image) {
  using namespace gnc::model_format;
  constexpr auto kSections = static_cast<std::uint32_t>(gnc::kModelSections<FixedPoint>);
  put_u16(image.data() + kOffsetVersion, gnc::kModelFormatVersion<FixedPoint>);
  put_u32(image.data() + kOffsetTotalSize, static_cast<std::uint32_t>(image.size()));
  put_u32(image.data() + kOffsetSectionCount, kSections);
  put_u32(image.data() + kOffsetHeaderCrc, header_crc(image.data(), kSections));
}

// Both sections in their full size.
SurfaceSections padded(SurfaceSections surface) {
  if (surface.points.empty()) surface.points.resize(gnc::SurfaceModel::kBytes);
  if (surface.points.size() != gnc::SurfaceModel::kBytes || surface.mesh.size() > gnc::SurfaceMesh::kMaxBytes)
    throw std::invalid_argument("a section of the target's surface has an impossible size");
  surface.mesh.resize(gnc::SurfaceMesh::kMaxBytes);
  return surface;
}

// `image`: of today's format version.
void set_surface(std::vector<std::uint8_t>& image, const SurfaceSections& surface) {
  image.resize(kPointsOffset);
  const SurfaceSections sections = padded(surface);
  append_section(image, kTensors, sections.points);
  append_section(image, kTensors + 1, sections.mesh);
  complete_header(image);
}

void upgrade(std::vector<std::uint8_t>& image) {
  const SurfaceSections unknown = padded({});
  if (has_format(image, kFormerFormats[0])) {
    set_surface(image, unknown);
  } else if (has_format(image, kFormerFormats[1])) {
    append_section(image, kTensors + 1, unknown.mesh);  // the points keep their CRC-32
    complete_header(image);
  }
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
  return fault_of_input(path, kModelImage);
}

std::vector<std::uint8_t> read_model_bytes(const std::string& path) {
  const std::string fault = fault_of_model_path(path);
  if (!fault.empty()) throw std::runtime_error(fault);
  std::vector<std::uint8_t> image = read_bytes(path, kModelImage);
  upgrade(image);
  return image;
}

namespace {

// That an image names; "<target>" for one that is damaged.
template <class N>
std::string target_of(const std::vector<std::uint8_t>& image) {
  gnc::ModelHeader header;
  const auto weights = std::make_unique<gnc::NetworkWeights<N>>();
  const gnc::ModelStatus status =
      gnc::read_model_image<N>(image.data(), image.size(), nullptr, header, *weights);
  return status == gnc::ModelStatus::kOk ? header.target.data() : "<target>";
}

}  // namespace

std::unique_ptr<Float32Model> read_float32_model(const std::string& path) {
  const std::vector<std::uint8_t> bytes = read_model_bytes(path);
  auto model = std::make_unique<Float32Model>();
  const gnc::ModelStatus status =
      gnc::read_model_image<Float32>(bytes.data(), bytes.size(), nullptr, model->header, model->weights);
  if (status == gnc::ModelStatus::kBadNumerics) {
    const std::string beside = model_stem(path) + ".float32.tsm";
    std::error_code error;
    throw std::runtime_error(
        "model image '" + path +
        "' is in fixed point; give the one in float32, as `tumblesight train` writes it: " +
        (std::filesystem::exists(beside, error) ? "--model " + beside
                                                : target_of<FixedPoint>(bytes) + ".float32.tsm"));
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
  if (status == gnc::ModelStatus::kBadNumerics) {
    throw std::runtime_error("model image '" + path + "' is in float32; give the one in fixed point (" +
                             target_of<Float32>(image) + ".tsm), as `tumblesight quantize --model " + path +
                             "` makes it");
  }
  throw std::runtime_error("model image '" + path + "' is refused: " + gnc::to_string(status));
}

template <class N>
std::uint32_t write_model_file(const std::string& path, const gnc::ModelHeader& header,
                               const gnc::NetworkWeights<N>& weights, const SurfaceSections& surface) {
  std::vector<std::uint8_t> bytes(gnc::kModelImageSize<N>);
  const SurfaceSections sections = padded(surface);
  bytes.resize(gnc::write_model_image<N>(header, weights, bytes.data(), bytes.size(),
                                         {sections.points.data(), sections.mesh.data()}));
  const std::uint32_t crc32 = checked_crc32<N>(bytes, path);
  write_file(path, bytes);
  return crc32;
}
template std::uint32_t write_model_file(const std::string&, const gnc::ModelHeader&,
                                        const gnc::NetworkWeights<Float32>&, const SurfaceSections&);
template std::uint32_t write_model_file(const std::string&, const gnc::ModelHeader&,
                                        const gnc::NetworkWeights<FixedPoint>&, const SurfaceSections&);

std::uint32_t write_with_surface(const std::string& from, const SurfaceSections& surface,
                                 const std::string& path) {
  (void)read_fixed_point_header(from);
  std::vector<std::uint8_t> image = read_model_bytes(from);
  set_surface(image, surface);
  const std::uint32_t crc32 = checked_crc32<FixedPoint>(image, path);
  write_file(path, image);
  return crc32;
}

}  // namespace tumblesight::sim
