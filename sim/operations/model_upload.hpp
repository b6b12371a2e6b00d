// ModelUpload: the ground side of the upload of a model image. It makes the telecommands and knows which
// segments to send.
//
//   1. begin(), and wait until the telemetry has bank_status LOADING
//   2. segment() of each of to_send(), in any order
//   3. missing_request(); segment() of each of missing() in the answer, until there is none
//   4. validate(), activate()
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/operations/signed_telecommand.hpp"

namespace tumblesight::sim {

class ModelUpload {
 public:
  // `base`: the image that the flight software uses, if only the differences are to be sent; it copies all
  // other segments by itself. Throws std::invalid_argument if the images differ in size.
  explicit ModelUpload(std::vector<std::uint8_t> image, const std::vector<std::uint8_t>& base = {});

  Telecommand begin() const;
  const std::vector<std::uint32_t>& to_send() const { return to_send_; }
  Telecommand segment(std::uint32_t number) const;
  Telecommand missing_request() const;
  // `dump`: the answer to missing_request().
  std::vector<std::uint32_t> missing(const std::vector<std::uint8_t>& dump) const;
  Telecommand validate() const;
  Telecommand activate() const;
  std::uint32_t crc32() const;  // which names the image

 private:
  std::uint32_t segments() const;
  std::size_t bytes_of(std::uint32_t segment) const;

  std::vector<std::uint8_t> image_;
  std::vector<std::uint32_t> to_send_;
  bool has_base_;
};

}  // namespace tumblesight::sim
