// Recordings in the format MCAP with any content: all messages are read, or a message names the file. What
// follows the first byte is the file; the lowest bit of this byte tells whether it gets a valid start.
#include "sim/recording/mcap_reader.hpp"

#include <array>
#include <stdexcept>

#include "tests/fuzz/fuzz.hpp"

namespace tumblesight::fuzz {
namespace {

constexpr std::size_t kLeastMessage = 9 + 22;  // bytes

std::vector<std::uint8_t> file_of(Input& input) {
  // The magic number and a header with two empty texts.
  constexpr std::array<std::uint8_t, 25> kStart{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n', 1, 8};
  std::vector<std::uint8_t> bytes;
  if ((input.u8() & 1) != 0) bytes.assign(kStart.begin(), kStart.end());
  bytes.insert(bytes.end(), input.rest(), input.rest() + input.left());
  return {bytes.begin(), bytes.end()};  // of exactly this size, so that AddressSanitizer sees its end
}

// The sum of the bytes, so that AddressSanitizer sees each of them.
unsigned sum_of(const sim::McapReader::Message& message) {
  unsigned sum = 0;
  for (std::size_t i = 0; i < message.size; ++i) sum += message.bytes[i];
  return sum;
}

void check(const sim::McapReader& reader, std::size_t file_size) {
  std::size_t messages = 0;
  for (const sim::McapReader::Channel& channel : reader.channels()) {
    require(reader.find(channel.topic) != nullptr, "a channel is found by its topic");
    const sim::McapReader::Entry* before = nullptr;
    for (const sim::McapReader::Entry& entry : reader.entries(channel.id)) {
      require(before == nullptr || before->chunk != entry.chunk || before->offset < entry.offset,
              "entries are in the order of the file");
      before = &entry;
      require(++messages <= file_size / kLeastMessage, "there are no more messages than the file can hold");
      const sim::McapReader::Message message = reader.read(channel.id, entry);
      require(message.time_ns == entry.time_ns, "a message has the time of its entry");
      require(sum_of(message) == sum_of(reader.read(channel.id, entry)), "a message is read the same again");
    }
  }
}

}  // namespace
}  // namespace tumblesight::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  fuzz::Input input(data, size);
  const std::vector<std::uint8_t> bytes = fuzz::file_of(input);
  try {
    fuzz::check(sim::McapReader::from_bytes(bytes, "any.mcap"), bytes.size());
  } catch (const std::runtime_error& error) {
    fuzz::require(std::string(error.what()).find("recording 'any.mcap': ") == 0, "a refusal names the file");
  }
  return 0;
}
