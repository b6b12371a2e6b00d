#include "sim/operations/model_upload.hpp"

#include <algorithm>
#include <stdexcept>

#include "gnc/rcnn/model_image.hpp"
#include "hal/messages/memory_dump.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::size_t kSegmentBytes = hal::kMaxModelSegmentBytes;

void append_u32(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

}  // namespace

ModelUpload::ModelUpload(std::vector<std::uint8_t> image, const std::vector<std::uint8_t>& base)
    : image_(std::move(image)), has_base_(!base.empty()) {
  if (has_base_ && base.size() != image_.size()) {
    throw std::invalid_argument("the image has " + std::to_string(image_.size()) + " bytes and its base " +
                                std::to_string(base.size()) + ": they are of different networks");
  }
  for (std::uint32_t number = 0; number < segments(); ++number) {
    const auto begin = static_cast<std::ptrdiff_t>(number * kSegmentBytes);
    const auto end = begin + static_cast<std::ptrdiff_t>(bytes_of(number));
    if (!has_base_ || !std::equal(image_.begin() + begin, image_.begin() + end, base.begin() + begin))
      to_send_.push_back(number);
  }
}

std::uint32_t ModelUpload::segments() const {
  return static_cast<std::uint32_t>((image_.size() + kSegmentBytes - 1) / kSegmentBytes);
}

std::size_t ModelUpload::bytes_of(std::uint32_t segment) const {
  return std::min(kSegmentBytes, image_.size() - segment * kSegmentBytes);
}

std::uint32_t ModelUpload::crc32() const {
  return gnc::model_image_crc32(image_.data());
}

Telecommand ModelUpload::begin() const {
  return {hal::FunctionCode::kModelBegin, {static_cast<std::uint8_t>(has_base_ ? 1 : 0)}};
}

Telecommand ModelUpload::segment(std::uint32_t number) const {
  Telecommand load{hal::FunctionCode::kModelLoad, {}};
  const std::size_t offset = number * kSegmentBytes;
  append_u32(load.arguments, static_cast<std::uint32_t>(offset));
  const auto first = image_.begin() + static_cast<std::ptrdiff_t>(offset);
  load.arguments.insert(load.arguments.end(), first, first + static_cast<std::ptrdiff_t>(bytes_of(number)));
  return load;
}

Telecommand ModelUpload::missing_request() const {
  Telecommand dump{hal::FunctionCode::kMemoryDump,
                   {static_cast<std::uint8_t>(hal::DumpedMemory::kMissingSegments), 0, 0, 0, 0}};
  const std::uint32_t bytes = (segments() + 7) / 8;
  dump.arguments.push_back(static_cast<std::uint8_t>(bytes >> 8));
  dump.arguments.push_back(static_cast<std::uint8_t>(bytes));
  return dump;
}

std::vector<std::uint32_t> ModelUpload::missing(const std::vector<std::uint8_t>& dump) const {
  std::vector<std::uint32_t> missing;
  for (std::uint32_t number = 0; number < segments() && number / 8 < dump.size(); ++number) {
    if ((dump[number / 8] & 0x80U >> number % 8) != 0) missing.push_back(number);
  }
  return missing;
}

Telecommand ModelUpload::validate() const {
  Telecommand command{hal::FunctionCode::kModelValidate, {}};
  append_u32(command.arguments, static_cast<std::uint32_t>(image_.size()));
  append_u32(command.arguments, crc32());
  return command;
}

Telecommand ModelUpload::activate() const {
  Telecommand command{hal::FunctionCode::kModelActivate, {}};
  append_u32(command.arguments, crc32());
  return command;
}

}  // namespace tumblesight::sim
