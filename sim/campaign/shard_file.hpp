// Shard file: the results of a part of an evaluation's sequences. One line of JSON says which evaluation and
// which part, then a record per sequence follows, each with a CRC-32. Records are only ever appended, so that
// a killed run loses at most the one that it was writing, and goes on after the last whole one.
//
// Layout, little-endian: "tumblesight shard 1\n"; the header, JSON, '\n'; CRC-32 of the header, 4 bytes;
// records. A record: index of the run and of the sequence, 4 bytes each; the frames, those that were not
// delivered too; times in milliseconds; CRC-32 of all that. Records of a run have the same size.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/campaign/experiment_identity.hpp"

namespace tumblesight::sim {

// Part `index` of `count`: the sequences index, index + count, index + 2 count and so on, of every run.
struct Shard {
  std::uint32_t index = 0;  // from 0
  std::uint32_t count = 1;
};
inline constexpr std::uint32_t kMostShards = 100'000;
std::string to_string(const Shard& shard);  // "3/16"
// Throws std::invalid_argument that names the text and what is wrong with it.
Shard shard_from(const std::string& text);
// The sequences 0 to `sequences` - 1 that belong to it, ascending.
std::vector<std::uint32_t> sequences_of(const Shard& shard, std::uint32_t sequences);

struct ShardHeader {
  ExperimentIdentity identity;
  Shard shard;
  std::string command;  // of the whole evaluation, in one process
  std::string commit;   // of the program that made it
};

using SequenceSet = std::vector<std::set<std::uint32_t>>;  // by run

class ShardInUse : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Appends to a file that is its own as long as this object lives.
class ShardWriter {
 public:
  // Goes on with a file of the same header, otherwise makes a new one. Throws std::runtime_error that names
  // the file: it is of something else (what differs, and the remedy), or it cannot be written; ShardInUse if
  // another process writes it.
  ShardWriter(const std::string& path, const ShardHeader& header);
  ~ShardWriter();
  ShardWriter(const ShardWriter&) = delete;
  ShardWriter& operator=(const ShardWriter&) = delete;

  const SequenceSet& done() const { return done_; }  // at the start
  // Bytes at the end of the file that were no whole record, and are gone.
  std::uint64_t dropped_bytes() const { return dropped_bytes_; }
  // Throws std::runtime_error if the disk is full.
  void append(std::size_t run, const SequenceResult& result);
  // To the disk. Throws likewise.
  void finish();

 private:
  void take_file();
  void start_file(const ShardHeader& header);
  void continue_file(const ShardHeader& header);
  [[noreturn]] void fail_to_write() const;

  std::string path_;
  std::vector<ExperimentRun> runs_;
  int file_ = -1;
  SequenceSet done_;
  std::uint64_t dropped_bytes_ = 0;
};

struct ShardContent {
  ShardHeader header;
  SequenceSet done;
  std::uint64_t size_bytes = 0;     // up to the end of the last whole record
  std::uint64_t dropped_bytes = 0;  // after it
  bool is_damaged = false;  // what follows is more than a record that is being written, or was cut off
};
// Throws std::runtime_error that names the file, and the remedy, if it cannot be read, is no shard file, or
// has records that are not of its shard, or twice.
ShardContent read_shard(const std::string& path);
// Gives the records of one run, an index of runs_of(), to `take`.
void read_run(const std::string& path, const ShardContent& content, std::size_t run,
              const std::function<void(SequenceResult&&)>& take);

// None: there is no such file, or its header is not complete yet. Throws as read_shard() does.
std::optional<ShardHeader> header_of(const std::string& path);
// "the last 12 bytes of 'a.shard' begin with an incomplete or damaged record; what they held is run again"
std::string dropped_text(const std::string& path, std::uint64_t dropped_bytes);
// Removes what follows the last whole record, so that its sequences are run again. Returns its size. Throws
// as read_shard() does, and ShardInUse if another process writes the file.
std::uint64_t cut_to_whole_records(const std::string& path);
// Records in a file with a single run, from its size alone: for a progress bar. 0 if it is no shard file.
// Throws std::runtime_error that names a file that is there and cannot be read.
std::uint64_t records_in(const std::string& path);
// Whether a process is writing the file.
bool is_in_use(const std::string& path);

}  // namespace tumblesight::sim
