// ModelBanks: the two banks for model images. It loads an image from the ground and keeps the good images
// free of bit flips.
//
// An image is loaded in segments, in any order, into the bank that is not in use. A bitmap tells which
// segments are missing. A segment that the ground does not send can be copied from the bank in use, so that
// an image that differs little needs few segments.
//
// The good image of each bank is checked block by block, a few blocks per cycle, against the bank's own table
// of checksums. If both banks hold the same image, a block that does not match is repaired from the same
// block of the other bank, if that one matches. A different good image is a fallback: nothing can repair it,
// but its loss is known before it is needed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "fsw/config/limits.hpp"
#include "fsw/config/numerics.hpp"
#include "gnc/rcnn/model_image.hpp"
#include "hal/messages/bank_status.hpp"
#include "hal/messages/command_packet.hpp"
#include "hal/model_store.hpp"

namespace tumblesight::fsw {

using hal::BankStatus;

// Every image that passes the checks has the size of the network's image.
inline constexpr std::uint32_t kModelImageBytes = gnc::kModelImageSize<Numerics>;
inline constexpr std::uint32_t kSegmentBytes = hal::kMaxModelSegmentBytes;
inline constexpr std::uint32_t kModelSegments = (kModelImageBytes + kSegmentBytes - 1) / kSegmentBytes;

struct BankDescriptor {
  std::uint32_t size_bytes = 0;
  std::uint32_t crc32 = 0;   // in the image's header, which covers the whole image
  std::uint32_t status = 0;  // BankStatus, as a whole word for the vote

  void set(BankStatus value) { status = static_cast<std::uint32_t>(value); }
};

// The state of ModelBanks that is kept in three copies (triple_redundant.hpp).
struct ModelBanksState {
  std::array<BankDescriptor, hal::kModelBanks> descriptor{};
  std::uint32_t in_use = 0;      // bank
  std::uint32_t next_block = 0;  // to be checked
  std::uint32_t next_copied =
      kModelSegments;  // first segment that is not copied yet; no copy: the number of all
  std::uint32_t segments_missing = 0;
  // Bit 7 of byte 0 is segment 0; 1: missing. There is at least one bit behind the last segment, always 0.
  std::array<std::uint8_t, kModelSegments / 8 + 1> missing{};
  std::array<std::uint32_t, hal::kModelBanks> table_crc32{};

  BankStatus status(std::uint32_t bank) const { return static_cast<BankStatus>(descriptor[bank].status); }
  std::uint32_t other() const { return 1 - in_use; }
  bool is_loading() const { return status(other()) == BankStatus::kLoading; }
  // The bank that is not in use is empty, and nothing is being loaded.
  void void_upload();
  bool has_second_copy() const {
    return status(0) == BankStatus::kGood && status(1) == BankStatus::kGood &&
           descriptor[0].crc32 == descriptor[1].crc32;
  }
};

// What the segments that the ground does not send hold.
enum class UploadBase : std::uint8_t {
  kNothing = 0,    // all are missing
  kBankInUse = 1,  // they are copied from the image in use
  kSameBank = 2,   // what the bank holds now, such as an image whose upload a reset interrupted
};

// Result of the check of one block.
struct BlockCheck {
  enum class Result : std::uint8_t {
    kGood,
    kRepaired,  // `bank` was corrupted
    kLost,      // `bank`, the one in use, is corrupted, and there is no good copy or the bank is read-only
    kFallbackLost,  // the same of the other bank
  };
  Result result = Result::kGood;
  std::uint32_t bank = 0;
  std::uint32_t block = 0;
};

class ModelBanks {
 public:
  static constexpr std::uint32_t kBlocks =
      (kModelImageBytes + config::kModelBlockBytes - 1) / config::kModelBlockBytes;

  // Begins an image in the bank that is not in use, whose content is void from then on. False: the bank is
  // read-only or too small.
  [[nodiscard]] static bool begin(hal::ModelStore& store, ModelBanksState& state, UploadBase base);
  // Writes a segment of `count` bytes of the image that was begun. `offset` is a multiple of kSegmentBytes,
  // and only the last segment of the image is shorter. A segment may come again. kRefused: it is no segment
  // of the image. kBusy: send it again later. kFailed: the image is void, now or because an earlier segment
  // could not be written.
  [[nodiscard]] static hal::WriteStatus load(hal::ModelStore& store, ModelBanksState& state,
                                             std::uint32_t offset, const std::uint8_t* bytes,
                                             std::uint32_t count);
  // Once per cycle: copies the next missing segments, at most config::kCopiedSegmentsPerCycle. kFailed: the
  // image is void.
  [[nodiscard]] static hal::WriteStatus continue_copy(hal::ModelStore& store, ModelBanksState& state);

  // Computes the table of checksums from the current content of `bank`. Call when its image has passed every
  // check.
  void make_table(std::uint32_t bank, hal::ModelStore& store, ModelBanksState& state);
  // Takes the table of the other bank for `bank`, if both banks hold the same image. False: they do not, or
  // the table is not the one that make_table() made.
  [[nodiscard]] bool restore_table(std::uint32_t bank, const ModelBanksState& state);
  bool table_is_sound(std::uint32_t bank, const ModelBanksState& state) const;
  // Checks the next block of the bank in use and of the other bank, if that one is good. Requires sound
  // tables of the good banks.
  BlockCheck check_block(hal::ModelStore& store, ModelBanksState& state);

 private:
  using Table = std::array<std::uint32_t, kBlocks>;
  static std::uint32_t crc32_of(const Table& table);

  std::array<Table, hal::kModelBanks> block_crc32_{};  // of each bank
};

}  // namespace tumblesight::fsw
