#include "sim/model/model_file.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

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
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
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

template <class N>
std::uint32_t write_model_file(const std::string& path, const gnc::ModelHeader& header,
                               const gnc::NetworkWeights<N>& weights) {
  std::vector<std::uint8_t> bytes(gnc::kModelImageSize<N>);
  bytes.resize(gnc::write_model_image<N>(header, weights, bytes.data(), bytes.size()));
  const std::uint32_t crc32 = checked_crc32<N>(bytes, path);
  std::ofstream out(path + ".new", std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw std::runtime_error("model image '" + path + "' cannot be written");
  std::filesystem::rename(path + ".new", path);
  return crc32;
}
template std::uint32_t write_model_file(const std::string&, const gnc::ModelHeader&,
                                        const gnc::NetworkWeights<Float32>&);
template std::uint32_t write_model_file(const std::string&, const gnc::ModelHeader&,
                                        const gnc::NetworkWeights<FixedPoint>&);

}  // namespace tumblesight::sim
