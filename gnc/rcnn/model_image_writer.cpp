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

}  // namespace

template <class N>
std::size_t write_model_image(const ModelHeader& header, const NetworkWeights<N>& weights, std::uint8_t* out,
                              std::size_t capacity, const TargetSurface& surface) {
  const std::size_t total = kModelImageSize<N>;
  if (capacity < total) return 0;
  std::memset(out, 0, kModelDataOffset<N>);
  std::memcpy(out, kMagic.data(), kMagic.size());
  put_u16(out + kOffsetVersion, kModelFormatVersion<N>);
  put_u16(out + kOffsetHeaderSize, static_cast<std::uint16_t>(kModelHeaderSize));
  put_u32(out + kOffsetTotalSize, static_cast<std::uint32_t>(total));
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

  std::uint8_t* entry = out + kModelHeaderSize;
  std::uint32_t id = 1;
  std::size_t offset = kModelDataOffset<N>;
  const auto add_section = [&](std::size_t size) {
    put_u32(entry, id++);
    put_u32(entry + 4, static_cast<std::uint32_t>(offset));
    put_u32(entry + 8, static_cast<std::uint32_t>(size));
    put_u32(entry + 12, crc32(out + offset, size));
    entry += kModelSectionEntrySize;
    offset += size;
  };
  for_each_tensor(weights, [&](const char*, const char*, const auto& tensor) {
    write(tensor, out + offset);
    add_section(size_in_image(tensor));
  });
  if (N::kIsInteger) {
    const auto add_surface = [&](const std::uint8_t* section, std::size_t size) {
      if (section == nullptr) {
        std::memset(out + offset, 0, size);
      } else {
        std::memcpy(out + offset, section, size);
      }
      add_section(size);
    };
    add_surface(surface.points, kSurfaceBytes<N>);
    add_surface(surface.mesh, kMeshBytes<N>);
  }
  put_u32(out + kOffsetHeaderCrc, header_crc(out, kModelSections<N>));
  return total;
}

template std::size_t write_model_image<FixedPoint>(const ModelHeader&, const NetworkWeights<FixedPoint>&,
                                                   std::uint8_t*, std::size_t, const TargetSurface&);
#if TUMBLESIGHT_FLOAT32
template std::size_t write_model_image<Float32>(const ModelHeader&, const NetworkWeights<Float32>&,
                                                std::uint8_t*, std::size_t, const TargetSurface&);
#endif

}  // namespace tumblesight::gnc
