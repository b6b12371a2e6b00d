// Serializes and deserializes samples of the bus. Recordings keep this form: an encapsulation header, then
// CDR.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/dds/idl/topics.hpp"

namespace tumblesight::sim {

// False: the bytes are no sample of this topic.
[[nodiscard]] bool read_cdr(const hal::dds::Topic& topic, const std::uint8_t* bytes, std::size_t size,
                            void* sample);

// The same with a type. `sample`: plain data without pointers, as all of tumblesight.idl is.
template <class Sample>
[[nodiscard]] bool read_cdr(const std::uint8_t* bytes, std::size_t size, Sample& sample) {
  return read_cdr(hal::dds::topic_of<Sample>(), bytes, size, &sample);
}

// The oldest sample of a reader as it came: encapsulation header and CDR. False: there is none.
bool take_cdr(dds_entity_t reader, std::vector<std::uint8_t>& bytes);

// Little-endian.
std::vector<std::uint8_t> cdr_of(const hal::dds::Topic& topic, const void* sample);
template <class Sample>
std::vector<std::uint8_t> cdr_of(const Sample& sample) {
  return cdr_of(hal::dds::topic_of<Sample>(), &sample);
}

}  // namespace tumblesight::sim
