#include "sim/recording/cdr_sample.hpp"

#include <dds/ddsi/ddsi_cdrstream.h>
#include <dds/ddsi/ddsi_serdata.h>

#include <cstring>
#include <memory>

namespace tumblesight::sim {
namespace {

constexpr std::size_t kHeaderBytes = 4;
constexpr std::size_t kMostBytes = 1 << 20;  // far more than any sample of the interface
// RTPS: 0 and 1 for CDR in big-endian and little-endian; others are not written for final types.
constexpr std::uint8_t kLittleEndian = 1;
constexpr std::uint32_t kXcdrVersion = 1;

}  // namespace

bool read_cdr(const hal::dds::Topic& topic, const std::uint8_t* bytes, std::size_t size, void* sample) {
  if (size <= kHeaderBytes || size > kMostBytes) return false;
  if (bytes[0] != 0 || bytes[1] > kLittleEndian) return false;
  const std::size_t padding = bytes[3] & 3U;
  const auto length = static_cast<std::uint32_t>(size - kHeaderBytes);
  if (padding >= length) return false;
  // Aligned, and writable for the change of the byte order.
  const std::uint32_t content = length - static_cast<std::uint32_t>(padding);
  const auto copy = std::make_unique<std::uint64_t[]>((content + 7) / 8);
  std::memcpy(copy.get(), bytes + kHeaderBytes, content);
  std::uint32_t read = 0;
  const bool swaps = (bytes[1] == kLittleEndian) != (DDSRT_ENDIAN == DDSRT_LITTLE_ENDIAN);
  if (dds_stream_normalize_data(reinterpret_cast<char*>(copy.get()), &read, content, swaps, kXcdrVersion,
                                topic.type->m_ops) == nullptr ||
      read != content)
    return false;
  dds_istream_t stream;
  dds_istream_init(&stream, content, copy.get(), kXcdrVersion);
  dds_stream_read(&stream, static_cast<char*>(sample), topic.type->m_ops);
  return true;
}

bool take_cdr(dds_entity_t reader, std::vector<std::uint8_t>& bytes) {
  for (;;) {
    ddsi_serdata* sample = nullptr;
    dds_sample_info_t info;
    if (dds_takecdr(reader, &sample, 1, &info, DDS_ANY_STATE) <= 0) return false;
    if (info.valid_data) {
      bytes.resize(ddsi_serdata_size(sample));
      ddsi_serdata_to_ser(sample, 0, bytes.size(), bytes.data());
    }
    ddsi_serdata_unref(sample);
    if (info.valid_data) return true;
  }
}

std::vector<std::uint8_t> cdr_of(const hal::dds::Topic& topic, const void* sample) {
  std::vector<std::uint8_t> bytes{0, kLittleEndian, 0, 0};
  dds_ostreamLE_t stream;
  dds_ostreamLE_init(&stream, 0, kXcdrVersion);
  dds_stream_writeLE(&stream, static_cast<const char*>(sample), topic.type->m_ops);
  bytes.insert(bytes.end(), stream.x.m_buffer, stream.x.m_buffer + stream.x.m_index);
  dds_ostreamLE_fini(&stream);
  // The header says by how many bytes the content is padded to a multiple of four.
  bytes[3] = static_cast<std::uint8_t>((4 - bytes.size() % 4) % 4);
  bytes.resize(bytes.size() + bytes[3]);
  return bytes;
}

}  // namespace tumblesight::sim
