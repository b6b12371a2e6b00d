// ModelBanks: the two places for model images. Loads one from the ground, keeps the one in use free of bit
// flips.
//
// The image in use is checked block by block, some blocks a cycle, against a table of checksums. Where the
// other bank holds the same image it is the second copy: of a block that differs, the copy that agrees with
// the table mends the other one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "fsw/config/limits.hpp"
#include "gnc/rcnn/model_image.hpp"
#include "hal/model_store.hpp"

namespace tumblesight::fsw {

enum class BankStatus : std::uint8_t {
  kEmpty = 0,    // nothing, or what was refused
  kLoading = 1,  // an image is coming in segments
  kGood = 2,     // a whole image that has passed every check
};

struct ModelBankRecord {
  std::uint32_t size_bytes = 0;
  std::uint32_t crc32 = 0;   // in the image's header, which covers all of it
  std::uint32_t status = 0;  // BankStatus
};

// What ModelBanks knows. Small, so that it can be kept three times (voted.hpp).
struct ModelBanksState {
  std::array<ModelBankRecord, hal::kModelBanks> record{};
  std::uint32_t in_use = 0;        // bank
  std::uint32_t loaded_bytes = 0;  // of the image that is coming in
  std::uint32_t next_block = 0;    // to be checked
  std::uint32_t table_crc32 = 0;

  BankStatus status(std::uint32_t bank) const { return static_cast<BankStatus>(record[bank].status); }
  std::uint32_t other() const { return 1 - in_use; }
  bool has_second_copy() const {
    return status(0) == BankStatus::kGood && status(1) == BankStatus::kGood &&
           record[0].crc32 == record[1].crc32;
  }
};

// One check of one block.
struct BlockCheck {
  enum class Result : std::uint8_t {
    kGood,
    kRepaired,  // `bank` had been hit
    kLost,      // `bank`, the one in use, has been hit, and there is no good copy or no way to write
  };
  Result result = Result::kGood;
  std::uint32_t bank = 0;
  std::uint32_t block = 0;
};

template <class N>
class ModelBanks {
 public:
  // Whatever passes the checks has the size of the network's image.
  static constexpr std::uint32_t kBlocks =
      (gnc::kModelImageSize<N> + config::kModelBlockBytes - 1) / config::kModelBlockBytes;

  // A segment for the bank that is not in use. Segments come in order; one at offset 0 begins a new image.
  // False: out of order, beyond the bank, or no bank that could be written.
  [[nodiscard]] static bool load(hal::ModelStore& store, ModelBanksState& state, std::uint32_t offset,
                                 const std::uint8_t* bytes, std::uint32_t count);

  // From now on the blocks of the bank in use are held to what they are now.
  void make_table(hal::ModelStore& store, ModelBanksState& state);
  bool table_is_sound(const ModelBanksState& state) const;
  // The next block of the bank in use, and of its second copy. Requires a sound table.
  BlockCheck check_block(hal::ModelStore& store, ModelBanksState& state);

 private:
  std::uint32_t table_crc32() const;

  std::array<std::uint32_t, kBlocks> block_crc32_{};
};

}  // namespace tumblesight::fsw
