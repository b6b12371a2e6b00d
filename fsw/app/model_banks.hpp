// ModelBanks: the two banks for model images. It loads an image from the ground and keeps the image in use
// free of bit flips.
//
// The image in use is checked block by block, a few blocks per cycle, against a table of checksums. If the
// other bank holds the same image, it is the second copy: a block that does not match the table is repaired
// from the same block of the other bank, if that one matches.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "fsw/config/limits.hpp"
#include "fsw/config/numerics.hpp"
#include "gnc/rcnn/model_image.hpp"
#include "hal/messages/bank_status.hpp"
#include "hal/model_store.hpp"

namespace tumblesight::fsw {

using hal::BankStatus;

struct BankDescriptor {
  std::uint32_t size_bytes = 0;
  std::uint32_t crc32 = 0;   // in the image's header, which covers the whole image
  std::uint32_t status = 0;  // BankStatus, as a whole word for the vote

  void set(BankStatus value) { status = static_cast<std::uint32_t>(value); }
};

// The state of ModelBanks that is kept in three copies (voted.hpp).
struct ModelBanksState {
  std::array<BankDescriptor, hal::kModelBanks> descriptor{};
  std::uint32_t in_use = 0;        // bank
  std::uint32_t loaded_bytes = 0;  // of the image that is being loaded
  std::uint32_t next_block = 0;    // to be checked
  std::uint32_t table_crc32 = 0;

  BankStatus status(std::uint32_t bank) const { return static_cast<BankStatus>(descriptor[bank].status); }
  std::uint32_t other() const { return 1 - in_use; }
  bool has_second_copy() const {
    return status(0) == BankStatus::kGood && status(1) == BankStatus::kGood &&
           descriptor[0].crc32 == descriptor[1].crc32;
  }
};

// Result of the check of one block.
struct BlockCheck {
  enum class Result : std::uint8_t {
    kGood,
    kRepaired,  // `bank` was corrupted
    kLost,      // `bank`, the one in use, is corrupted, and there is no good copy or the bank is read-only
  };
  Result result = Result::kGood;
  std::uint32_t bank = 0;
  std::uint32_t block = 0;
};

class ModelBanks {
 public:
  // Every image that passes the checks has the size of the network's image.
  static constexpr std::uint32_t kBlocks =
      (gnc::kModelImageSize<Numerics> + config::kModelBlockBytes - 1) / config::kModelBlockBytes;

  // Writes a segment of `count` bytes to the bank that is not in use. Segments must come in order; a segment
  // with offset 0 begins a new image. kRefused: out of order, beyond the end of the bank, or the bank is
  // read-only. kBusy: send the segment again later. kFailed: the image is void, now or because an earlier
  // segment could not be written.
  [[nodiscard]] static hal::WriteStatus load(hal::ModelStore& store, ModelBanksState& state,
                                             std::uint32_t offset, const std::uint8_t* bytes,
                                             std::uint32_t count);

  // Computes the table of checksums from the current content of the bank in use.
  void make_table(hal::ModelStore& store, ModelBanksState& state);
  bool table_is_sound(const ModelBanksState& state) const;
  // Checks the next block of the bank in use and of its second copy. Requires a sound table.
  BlockCheck check_block(hal::ModelStore& store, ModelBanksState& state);

 private:
  std::uint32_t table_crc32() const;

  std::array<std::uint32_t, kBlocks> block_crc32_{};
};

}  // namespace tumblesight::fsw
