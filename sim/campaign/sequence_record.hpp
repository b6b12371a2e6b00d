// Sequence record: the result of one sequence as bytes of a fixed size, every number with all its bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/experiment/sequence_result.hpp"

namespace tumblesight::sim {

// Of a sequence with so many frames, with its CRC-32.
std::size_t record_size_bytes(std::uint32_t frames);

std::vector<std::uint8_t> to_record(std::uint32_t run, const SequenceResult& result, std::uint32_t frames);

// The run at the start of a record, of which at least four bytes are there.
std::uint32_t run_of_record(const std::uint8_t* bytes);
// No value if the CRC-32 is wrong. `bytes`: record_size_bytes(frames).
std::optional<SequenceResult> from_record(const std::uint8_t* bytes, std::uint32_t frames);

}  // namespace tumblesight::sim
