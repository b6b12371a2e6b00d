// McapReader: reads recordings of messages in the format MCAP (mcap.dev/spec) without compression. McapWriter
// or another program wrote them. A program that was killed before it wrote the end of the file leaves a
// readable recording, too.
//
// The file is mapped, not read into memory. A complete file is opened by its summary and its message indices,
// so that opening reads little of it. A file whose end or whose indices are missing is read once from the
// start to its last complete record, with all checksums.
//
// Nothing in the file is trusted: every length, offset, count and id is checked before it is used, and a
// message of a chunk is returned only if the chunk's checksum is right and the message is the one that the
// index names. A checksum of 0 means that the writer computed none.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/recording/mcap_writer.hpp"

namespace tumblesight::sim {

class McapReader {
 public:
  // In place of a chunk's number: the message stands in the file itself.
  static constexpr std::uint64_t kNoChunk = std::numeric_limits<std::uint64_t>::max();

  // The schema's name, encoding and text are empty if the channel has none.
  struct Channel {
    McapId id;
    std::string topic, encoding, schema_name, schema_encoding, schema_text;
  };
  struct Entry {
    std::uint64_t time_ns;
    std::uint64_t chunk;   // its number in the file from 0 on, or kNoChunk
    std::uint64_t offset;  // of the message in the chunk, or in the file
  };
  // Valid as long as the reader.
  struct Message {
    const std::uint8_t* bytes;
    std::size_t size;
    std::uint64_t time_ns;
  };

  // Throws std::runtime_error, as all functions do, that names the file, what is wrong at which byte, and the
  // remedy. The file may grow while it is mapped. A file that has become shorter is refused, unless it is cut
  // off during a read.
  explicit McapReader(const std::string& path);
  // The same from memory. `name`: stands for the file in messages.
  static McapReader from_bytes(std::vector<std::uint8_t> bytes, std::string name);

  // False: the program that wrote the file was killed. The messages before the missing end can be read.
  bool is_whole() const { return is_whole_; }
  const std::vector<Channel>& channels() const { return contents_.channels; }
  // The first channel of this topic; null if there is none.
  const Channel* find(const std::string& topic) const;
  // In the order of the file. The messages are not read: only read() finds a damaged chunk. Throws
  // std::logic_error for an id that channels() does not have, as read() does.
  const std::vector<Entry>& entries(McapId channel) const;
  // Several threads may read at once. Checks a chunk when the first of its messages is read.
  Message read(McapId channel, const Entry& entry) const;

 private:
  // Offsets are those of the file.
  struct Record {
    std::uint8_t opcode;
    std::uint64_t start, content, size;  // of the record, of its content, bytes of its content
    std::uint64_t end() const { return content + size; }
  };
  struct Chunk {
    std::uint64_t start, records, size;  // of its record, of the records in it, their bytes
    std::uint32_t crc;
    std::uint64_t end() const { return records + size; }  // of the records
  };
  // The texts stand in the file.
  struct Schema {
    std::string_view name, encoding, text;
  };
  struct ChannelEntries {
    McapId schema = 0;      // 0: none
    std::size_t place = 0;  // of the channel in `channels`
    std::vector<Entry> entries;
  };
  struct Contents {
    std::map<McapId, Schema> schemas;
    std::vector<Channel> channels;
    std::map<McapId, ChannelEntries> entries;
    std::vector<Chunk> chunks;
    std::uint64_t schema_bytes = 0;  // in all channels
  };
  // What the bytes are read from: a mapping or memory.
  class Descriptor;
  struct File {
    std::string name;
    std::shared_ptr<const std::uint8_t> bytes;
    std::uint64_t size;
    std::shared_ptr<const Descriptor> descriptor{};  // of a mapping
  };
  class Fields;

  explicit McapReader(File file);
  static File mapped(const std::string& path);
  [[noreturn]] static void fail(const std::string& name, const std::string& what);
  [[noreturn]] void damaged(std::uint64_t at, const std::string& what) const;

  void require_same_length() const;
  void require_start() const;
  // A record that ends at `end` at the latest.
  std::optional<Record> record_at(std::uint64_t at, std::uint64_t end) const;
  Record required_record(std::uint64_t at, std::uint64_t end) const;
  std::optional<Record> footer() const;
  std::uint32_t crc_of(std::uint64_t start, std::uint64_t end) const;

  // False: the summary does not have all that is needed.
  bool open_by_summary(const Record& footer);
  std::uint64_t summary_start(const Record& footer) const;
  bool read_chunk_indices(std::vector<Record> chunk_indices, std::uint64_t end, std::uint64_t messages);
  bool read_message_indices(const Record& chunk_index, std::uint64_t end, std::uint64_t& messages_left);
  bool read_message_index(const Record& index, McapId channel, std::uint64_t& messages_left);

  // Reads all records from the start on.
  void scan(std::uint64_t end);
  void scan_chunk(const Record& record);
  void require_data_checksum(const Record& data_end) const;
  void add(const Record& record, std::uint64_t chunk, std::uint64_t chunk_records);
  void add_schema(const Record& record);
  // False: its schema is not there.
  bool add_channel(const Record& record);
  void add_message(const Record& record, std::uint64_t chunk, std::uint64_t chunk_records);
  Chunk chunk_of(const Record& record) const;
  void require_checksum(const Chunk& chunk) const;

  File file_;
  bool is_whole_ = false;
  Contents contents_;
  std::unique_ptr<std::atomic<bool>[]> is_checked_;  // of every chunk: its checksum fits
};

}  // namespace tumblesight::sim
