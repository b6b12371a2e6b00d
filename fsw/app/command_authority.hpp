// CommandAuthority: who may command the application, and under which APID. It is part of the
// triple-redundant state: otherwise a bit flip in a key would make every genuine command look forged.
#pragma once

#include <cstdint>

#include "hal/command_authentication.hpp"
#include "hal/messages/command_key.hpp"
#include "hal/messages/command_packet.hpp"

namespace tumblesight::fsw {

class CommandAuthority {
 public:
  // Copies the keys, and uses the lowest slot that holds one. nullptr: the link delivers authentic commands
  // only, without a security trailer.
  void set(const hal::CommandKeys* keys, std::uint16_t apid = hal::kCommandApid) {
    apid_ = apid;
    has_keys_ = keys != nullptr;
    keys_ = has_keys_ ? *keys : hal::CommandKeys{};
    for (std::uint32_t slot = hal::kCommandKeySlots; slot > 0; --slot) (void)use(slot - 1);
  }
  const hal::CommandKeys* keys() const { return has_keys_ ? &keys_ : nullptr; }
  std::uint16_t apid() const { return apid_; }  // of the packets that are commands
  // Whether there is a key in the slot.
  bool has_key(std::uint32_t slot) const { return keys_.has_key(slot); }
  // What proves possession of the key in the slot (hal::proof_of_key). Requires has_key(slot).
  gnc::Sha256Digest proof_of_key(std::uint8_t slot, std::uint32_t counter) const {
    return hal::proof_of_key(keys_, slot, counter);
  }
  std::uint32_t slot() const { return slot_; }  // of the key in use
  // False: the slot is empty or does not exist.
  [[nodiscard]] bool use(std::uint32_t slot) {
    if (!has_key(slot)) return false;
    slot_ = slot;
    return true;
  }

 private:
  hal::CommandKeys keys_;
  std::uint32_t slot_ = 0;
  std::uint16_t apid_ = hal::kCommandApid;
  bool has_keys_ = false;
};

}  // namespace tumblesight::fsw
