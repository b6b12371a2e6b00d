// Domain: the connection of a process to the bus. It uses loopback only, so nothing leaves the machine.
// Discovery is unicast, so it also works without multicast.
#pragma once

#include <dds/dds.h>

#include <cstdint>

namespace tumblesight::hal::dds {

inline constexpr std::uint32_t kMaxDomain = 230;  // the highest one with valid UDP ports

inline constexpr const char* kPatientLease = "1hr";  // the longest that Cyclone takes

// The element <Security> of Cyclone's configuration, as hal/dds/make_security writes it.
struct SecurityElement {
  char text[8192] = {};
};
// False: the file cannot be read or is too large.
[[nodiscard]] bool read_security(const char* path, SecurityElement& security);

// Whether the machine has the interface that the bus uses, up and with its address. True if that is not
// known.
bool has_loopback();

// Of a return code: what Domain::open() could not do. Names the loopback interface if that is the reason.
const char* text_of_failure(dds_return_t code);

class Domain {
 public:
  Domain() = default;
  ~Domain() { close(); }
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;

  // Creates domain and participant, in place of those of an earlier call. Endpoints meet those of the same
  // `partition` only; empty: the default one; it must outlive the domain. `further`: elements of Cyclone's
  // configuration beside those of every domain, such as <Security>, without which the bus is not secured.
  // `lease`: after which other programs notice that this one was killed; kPatientLease is for those that a
  // pause must not end. Returns 0 or a negative DDS return code; text_of_failure() gives its text.
  [[nodiscard]] dds_return_t open(std::uint32_t id, const char* partition = "", const char* further = "",
                                  const char* lease = kPatientLease);
  // Deletes the domain with all its readers and writers.
  void close();
  dds_entity_t participant() const { return participant_; }
  std::uint32_t id() const { return id_; }
  // Another participant in the same domain, for whoever listens to this one. Returns it or a negative DDS
  // return code. It ends with the domain, or by dds_delete().
  [[nodiscard]] dds_entity_t join() const;
  const char* partition() const { return partition_; }

 private:
  std::uint32_t id_ = 0;
  dds_entity_t domain_ = 0;
  dds_entity_t participant_ = 0;
  const char* partition_ = "";
};

}  // namespace tumblesight::hal::dds
