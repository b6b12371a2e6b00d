// McapWriter: writes recordings of messages with times and schemas. Foxglove, Lichtblick, PlotJuggler and
// other programs open them. Format: MCAP (mcap.dev/spec), without compression, with indices and checksums.
//
// Messages are collected in chunks. A chunk is written when it has reached a mebibyte, or when its first
// message is a second old (write_due()). A program that is killed therefore loses at most one second of a
// recording. Such a file has no end, but its messages can be read, and `mcap recover` adds the end.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gnc/numerics/crc.hpp"

namespace tumblesight::sim {

class Place;
using McapId = std::uint16_t;  // of a schema or a channel, from 1 on

class McapWriter {
 public:
  // Creates the file. A file of that name is replaced, not overwritten: a program that has it open keeps the
  // old content. Throws std::runtime_error, as all functions do, that names the file and what is wrong.
  // `library`: name of the program that writes.
  McapWriter(std::string path, const std::string& library);
  ~McapWriter();  // closes as far as it can
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  // `encoding`: of the schema, such as "jsonschema" or "omgidl".
  McapId add_schema(const std::string& name, const std::string& encoding, std::string_view text);
  // `encoding`: of the messages, such as "json" or "cdr".
  McapId add_channel(const std::string& topic, const std::string& encoding, McapId schema);
  // `time_ns`: not negative. Messages may come in any order.
  void write(McapId channel, std::int64_t time_ns, const std::uint8_t* bytes, std::size_t size);
  void write(McapId channel, std::int64_t time_ns, std::string_view text);
  // Writes the messages that came more than a second ago. Call it several times a second, also while no
  // message arrives.
  void write_due();
  // Writes the last chunk and the summary. Nothing may be written afterwards.
  void close();
  std::uint64_t messages() const { return messages_; }

 private:
  struct IndexEntry {
    std::uint64_t time_ns, offset;  // of the message in the chunk
  };
  struct ChunkIndex {
    std::uint64_t first_ns, last_ns, start, length, size;
    std::map<McapId, std::uint64_t> index_offsets;
    std::uint64_t index_length;
  };
  struct Channel {
    std::uint32_t sequence = 0;
    std::vector<IndexEntry> in_chunk;
  };
  using Bytes = std::vector<std::uint8_t>;

  void open_alone(const Place& place);
  void replace(const Place& place);
  void put(const Bytes& bytes);
  void write_chunk();
  Bytes statistics() const;
  void write_summary();
  [[noreturn]] void fail(const std::string& what) const;

  std::string path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::uint64_t position_ = 0;
  gnc::Crc32 crc_;  // of the file so far
  std::vector<Bytes> schemas_, channel_records_;
  std::map<McapId, Channel> channels_;
  Bytes chunk_;
  std::uint64_t chunk_first_ns_ = 0, chunk_last_ns_ = 0;
  std::chrono::steady_clock::time_point chunk_began_;
  std::vector<ChunkIndex> chunks_;
  std::uint64_t messages_ = 0, first_ns_ = 0, last_ns_ = 0;
  bool has_failed_ = false;
};

}  // namespace tumblesight::sim
