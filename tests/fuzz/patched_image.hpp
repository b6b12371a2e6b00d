// PatchedImage: a whole model image with some of its bytes replaced as an input says. It lies in memory once,
// since an image has more than a megabyte and an input a few bytes; what was replaced is put back at the end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

namespace tumblesight::fuzz {

class PatchedImage {
 public:
  // `image`: one that is accepted.
  explicit PatchedImage(std::vector<std::uint8_t> image);

  // Reads the patches from the input, applies them and, where the input wants it, corrects the CRCs of the
  // sections and of the header, so that the reader's checks of values are reached. Gives the size that the
  // reader is to be told: mostly the image's; the bytes behind it are out of bounds (AddressSanitizer).
  // Without `with_values` the sections stay as they are, and their CRCs are taken for wrong: the last one's
  // and those of sections that a patch would have touched. So the reader never comes to the values, which
  // take a thousand times longer.
  std::size_t apply(Input& input, bool with_values);
  void undo();

  const std::uint8_t* data() const { return bytes_.data(); }
  // What is to be taken for the CRC-32 of these bytes, if they are a section: see apply(). False: work it
  // out.
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
  std::size_t size_ = 0;  // that the reader was told
};

// The one that known_crc32.cpp asks; it lives as long as the program.
inline const PatchedImage* the_image = nullptr;

}  // namespace tumblesight::fuzz
