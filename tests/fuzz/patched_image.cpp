#include "tests/fuzz/patched_image.hpp"

#include <algorithm>
#include <cstring>

#include "gnc/numerics/crc.hpp"
#include "gnc/rcnn/model_image.hpp"

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define TUMBLESIGHT_POISONS 1
#include <sanitizer/asan_interface.h>
#endif
#endif

namespace tumblesight::fuzz {
namespace {

constexpr std::size_t kOffsetSectionCount = 88;
constexpr std::size_t kOffsetHeaderCrc = 92;
constexpr int kMostPatches = 16;

std::uint32_t get_u32(const std::uint8_t* at) {
  return Input(at, 4).u32();
}
void put_u32(std::uint8_t* at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) at[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

void forbid([[maybe_unused]] const std::uint8_t* first, [[maybe_unused]] std::size_t size) {
#if TUMBLESIGHT_POISONS
  ASAN_POISON_MEMORY_REGION(first, size);
#endif
}
void allow([[maybe_unused]] const std::uint8_t* first, [[maybe_unused]] std::size_t size) {
#if TUMBLESIGHT_POISONS
  ASAN_UNPOISON_MEMORY_REGION(first, size);
#endif
}

}  // namespace

PatchedImage::PatchedImage(std::vector<std::uint8_t> image) : original_(std::move(image)), bytes_(original_) {
  const std::size_t count = get_u32(bytes_.data() + kOffsetSectionCount);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t entry = gnc::kModelHeaderSize + i * gnc::kModelSectionEntrySize;
    const std::uint8_t* const at = bytes_.data() + entry;
    sections_.push_back({entry, get_u32(at + 4), get_u32(at + 8), get_u32(at + 12)});
  }
  the_image = this;
  with_values_ = false;
  const Section& last = sections_.back();
  require(gnc::crc32(bytes_.data() + last.offset, last.size) != last.crc32,
          "the linker replaces gnc::crc32()");
  with_values_ = true;
}

std::size_t PatchedImage::apply(Input& input, bool with_values) {
  with_values_ = with_values;
  enum : std::uint8_t { kCorrectSections = 1, kCorrectHeader = 2, kCut = 4 };
  const std::uint8_t flags = input.u8();
  size_ = (flags & kCut) != 0 ? std::min<std::size_t>(input.u24(), bytes_.size()) : bytes_.size();
  for (int i = 0; i < kMostPatches && !input.empty(); ++i) patch(input);
  if (with_values && (flags & kCorrectSections) != 0) correct_sections();
  if ((flags & kCorrectHeader) != 0) correct_header();
  forbid(bytes_.data() + size_, bytes_.size() - size_);
  return size_;
}

// Where: 0 is the header and section table, n the nth section. What: a number of one or four bytes, once or
// repeatedly.
void PatchedImage::patch(Input& input) {
  const std::size_t where = input.u8() % (sections_.size() + 1);
  const std::uint8_t how = input.u8();
  const int width = (how & 1) != 0 ? 4 : 1;
  const bool often = (how & 2) != 0;
  const std::size_t step = static_cast<std::size_t>(width) * (1U + (how >> 2));
  const std::size_t begin = where == 0 ? 0 : sections_[where - 1].offset;
  const std::size_t size = where == 0 ? sections_.front().offset : sections_[where - 1].size;
  std::size_t first = (where == 0 ? input.u16() : input.u24()) % size;
  if (where > 0 && width == 4) first -= first % 4;
  const std::size_t room =
      size - first < static_cast<std::size_t>(width) ? 0 : (size - first - width) / step + 1;
  const std::size_t count = std::min<std::size_t>(often ? input.u24() : 1, room);
  const std::uint32_t value = width == 4 ? input.u32() : input.u8();
  if (where > 0) sections_[where - 1].patched = true;
  if (where == 0 || with_values_) write(begin + first, step, count, value, width);
}

void PatchedImage::write(std::size_t first, std::size_t step, std::size_t count, std::uint32_t value,
                         int width) {
  std::uint8_t bytes[4];
  put_u32(bytes, value);
  for (std::size_t i = 0; i < count; ++i) std::memcpy(bytes_.data() + first + i * step, bytes, width);
  if (count > 0) patched_.push_back({first, (count - 1) * step + static_cast<std::size_t>(width)});
}

void PatchedImage::correct_sections() {
  for (const Section& section : sections_) {
    if (!section.patched) continue;
    put_u32(bytes_.data() + section.entry + 12, gnc::crc32(bytes_.data() + section.offset, section.size));
    patched_.push_back({section.entry + 12, 4});
  }
}

// Over as many sections as the header now gives, as in the reader.
void PatchedImage::correct_header() {
  const std::uint64_t sections = get_u32(bytes_.data() + kOffsetSectionCount);
  const std::uint64_t end = (gnc::kModelHeaderSize + sections * gnc::kModelSectionEntrySize + 63) / 64 * 64;
  if (end > bytes_.size()) return;
  gnc::Crc32 crc;
  crc.add(bytes_.data(), kOffsetHeaderCrc);
  crc.add(bytes_.data() + gnc::kModelHeaderSize, end - gnc::kModelHeaderSize);
  put_u32(bytes_.data() + kOffsetHeaderCrc, crc.value());
  patched_.push_back({kOffsetHeaderCrc, 4});
}

bool PatchedImage::knows_crc32(const std::uint8_t* first, std::size_t size, std::uint32_t& crc32) const {
  const auto is_it = [&](const Section& section) {
    return first == bytes_.data() + section.offset && size == section.size;
  };
  const auto section = std::find_if(sections_.begin(), sections_.end(), is_it);
  if (section == sections_.end()) return false;
  const bool is_wrong = section->patched || section == sections_.end() - 1;
  crc32 = with_values_ || !is_wrong ? section->crc32 : ~section->crc32;
  return !with_values_ || !section->patched;
}

void PatchedImage::undo() {
  allow(bytes_.data() + size_, bytes_.size() - size_);
  for (const Range& range : patched_) {
    std::memcpy(bytes_.data() + range.first, original_.data() + range.first, range.size);
  }
  patched_.clear();
  for (Section& section : sections_) section.patched = false;
}

}  // namespace tumblesight::fuzz

// Replaces gnc::crc32() in programs linked with --wrap: for the sections of a patched image, the CRC is the
// one that the image gives. The linker's names of the original gnc::crc32() and of its replacement.
extern "C" std::uint32_t __real__ZN11tumblesight3gnc5crc32EPKhm(const std::uint8_t* data,
                                                                std::size_t size_bytes);
extern "C" std::uint32_t __wrap__ZN11tumblesight3gnc5crc32EPKhm(const std::uint8_t* data,
                                                                std::size_t size_bytes) {
  std::uint32_t known;
  const tumblesight::fuzz::PatchedImage* const image = tumblesight::fuzz::the_image;
  const bool is_known = image != nullptr && image->knows_crc32(data, size_bytes, known);
  return is_known ? known : __real__ZN11tumblesight3gnc5crc32EPKhm(data, size_bytes);
}
