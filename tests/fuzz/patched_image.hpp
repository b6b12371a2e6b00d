// PatchedImage: a whole model image with some bytes replaced, as an input specifies. An image has more than a
// megabyte and an input a few bytes, so there is one image in memory and the replaced bytes are restored
// after each input.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

namespace tumblesight::fuzz {

class PatchedImage {
 public:
  // `image` must be valid.
  explicit PatchedImage(std::vector<std::uint8_t> image);

  // Reads the patches from the input and applies them. If the input asks for it, corrects the CRCs of the
  // sections and of the header, so that the reader's checks of values are reached. Returns the size to give
  // to the reader, usually the image's; bytes beyond it are out of bounds for AddressSanitizer. Without
  // `with_values` the sections are not patched. Instead, the CRCs of the last section and of those that a
  // patch would have changed are reported as wrong, so that the reader does not reach the values, which take
  // a thousand times longer.
  std::size_t apply(Input& input, bool with_values);
  void undo();

  const std::uint8_t* data() const { return bytes_.data(); }
  // Gives the CRC-32 to use for these bytes if they are a section: see apply(). False: compute it.
  bool knows_crc32(const std::uint8_t* first, std::size_t size, std::uint32_t& crc32) const;

 private:
  struct Section {
    std::size_t entry, offset, size;
    std::uint32_t crc32;  // of the original
    bool patched = false;
  };
  struct Range {
    std::size_t first, size;
  };

  void patch(Input& input);
  void write(std::size_t first, std::size_t step, std::size_t count, std::uint32_t value, int width);
  void correct_sections();
  void correct_header();

  const std::vector<std::uint8_t> original_;
  std::vector<std::uint8_t> bytes_;
  std::vector<Section> sections_;
  std::vector<Range> patched_;
  bool with_values_ = true;
  std::size_t size_ = 0;  // given to the reader
};

// The image that the replacement of gnc::crc32() asks; it exists until the program ends.
inline const PatchedImage* the_image = nullptr;

}  // namespace tumblesight::fuzz
