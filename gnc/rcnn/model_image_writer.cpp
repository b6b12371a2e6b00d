#include <cstring>

#include "gnc/rcnn/model_format.hpp"

namespace tumblesight::gnc {
namespace {

using namespace model_format;

template <std::size_t kCount>
void write(const FixedPoint::Weights<kCount>& tensor, std::uint8_t* to) {
  std::memcpy(to, tensor.data(), kCount);
}
template <std::size_t kCount>
void write(const std::array<float, kCount>& tensor, std::uint8_t* to) {
  for (std::size_t i = 0; i < kCount; ++i) put_f32(to + 4 * i, tensor[i]);
}
template <class Integer, std::size_t kCount>
void write(const std::array<Integer, kCount>& tensor, std::uint8_t* to) {
  for (std::size_t i = 0; i < kCount; ++i) put_u32(to + 4 * i, static_cast<std::uint32_t>(tensor[i]));
}

// All but the CRC of the header, which covers the sections' CRCs.
template <class N>
void write_header(const ModelHeader& header, std::uint8_t* out) {
  std::memset(out, 0, kModelDataOffset<N>);
  std::memcpy(out, kMagic.data(), kMagic.size());
  put_u16(out + kOffsetVersion, kModelFormatVersion<N>);
  put_u16(out + kOffsetHeaderSize, static_cast<std::uint16_t>(kModelHeaderSize));
  put_u32(out + kOffsetTotalSize, static_cast<std::uint32_t>(kModelImageSize<N>));
  put_u32(out + kOffsetArchitecture, architecture_hash());
  std::memcpy(out + kOffsetTarget, header.target.data(), header.target.size());
  put_u32(out + kOffsetSwath, header.projection.swath_mm);
  put_u32(out + kOffsetRadius, header.projection.target_radius_mm);
  const bool is_default = header.noise == RangeNoise{};
  put_u16(out + kOffsetNoise, is_default ? 0 : header.noise.constant_mm);
  put_u16(out + kOffsetNoise + 2, is_default ? 0 : header.noise.share_1e5);
  for (std::size_t i = 0; i < kInertiaElements.size(); ++i) {
    const auto [row, column] = kInertiaElements[i];
    put_u32(out + kOffsetInertia + 4 * i,
            static_cast<std::uint32_t>(header.inertia.tensor_trf(row, column).raw()));
  }
  put_u32(out + kOffsetNumerics, numerics_of<N>());
  put_u32(out + kOffsetSectionCount, static_cast<std::uint32_t>(kModelSections<N>));
  put_u32(out + mission_offset(kModelSections<N>), header.mission_crc32);
}

// The sections, one behind the other, and their entries in the table.
class SectionWriter {
 public:
  SectionWriter(std::uint8_t* image, std::size_t offset)
      : image_(image), entry_(image + kModelHeaderSize), offset_(offset) {}

  template <class Tensor>
  void add(const Tensor& tensor) {
    write(tensor, image_ + offset_);
    add_entry(size_in_image(tensor));
  }
  // nullptr: zeros.
  void add(const std::uint8_t* section, std::size_t size) {
    if (section == nullptr) {
      std::memset(image_ + offset_, 0, size);
    } else {
      std::memcpy(image_ + offset_, section, size);
    }
    add_entry(size);
  }

 private:
  void add_entry(std::size_t size) {
    put_u32(entry_, id_++);
    put_u32(entry_ + 4, static_cast<std::uint32_t>(offset_));
    put_u32(entry_ + 8, static_cast<std::uint32_t>(size));
    put_u32(entry_ + 12, crc32(image_ + offset_, size));
    entry_ += kModelSectionEntrySize;
    offset_ += size;
  }

  std::uint8_t* image_;
  std::uint8_t* entry_;  // the next one in the table
  std::size_t offset_;   // of the next section
  std::uint32_t id_ = 1;
};

}  // namespace

template <class N>
std::size_t write_model_image(const ModelHeader& header, const NetworkWeights<N>& weights, std::uint8_t* out,
                              std::size_t capacity, const TargetSurface& surface) {
  if (capacity < kModelImageSize<N>) return 0;
  write_header<N>(header, out);
  SectionWriter sections(out, kModelDataOffset<N>);
  for_each_tensor(weights,
                  [&sections](const char*, const char*, const auto& tensor) { sections.add(tensor); });
  if (N::kIsInteger) {
    sections.add(surface.points, kSurfaceBytes<N>);
    sections.add(surface.mesh, kMeshBytes<N>);
  }
  put_u32(out + kOffsetHeaderCrc, header_crc(out, kModelSections<N>));
  return kModelImageSize<N>;
}

template std::size_t write_model_image<FixedPoint>(const ModelHeader&, const NetworkWeights<FixedPoint>&,
                                                   std::uint8_t*, std::size_t, const TargetSurface&);
#if TUMBLESIGHT_FLOAT32
template std::size_t write_model_image<Float32>(const ModelHeader&, const NetworkWeights<Float32>&,
                                                std::uint8_t*, std::size_t, const TargetSurface&);
#endif

}  // namespace tumblesight::gnc
