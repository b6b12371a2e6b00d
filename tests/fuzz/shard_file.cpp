// Shard files: any bytes, valid headers with any bytes after them, and records of any sequences. What is read
// is consistent, and a file that was cut to its whole records is read again as it was.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/campaign/sequence_record.hpp"
#include "sim/campaign/shards.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tumblesight::fuzz {
namespace {

constexpr std::uint32_t kFrames = 2;

// In memory.
class File {
 public:
  File() : path_("/proc/self/fd/" + std::to_string(file_)) { require(file_ >= 0, "a file can be made"); }
  ~File() { close(file_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  const std::string& path() const { return path_; }
  void fill(const std::string& bytes) const {
    require(ftruncate(file_, 0) == 0, "the file can be emptied");
    require(pwrite(file_, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()),
            "the file takes all bytes");
  }
  std::string content() const {
    std::string bytes(static_cast<std::size_t>(std::max<off_t>(0, lseek(file_, 0, SEEK_END))), '\0');
    require(pread(file_, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()),
            "the file gives all bytes");
    return bytes;
  }

 private:
  int file_ = memfd_create("shard", MFD_CLOEXEC);
  std::string path_;
};

// Of part 1 of 3 of ten sequences.
std::string header_of_a_shard() {
  sim::ExperimentSettings settings;
  settings.sequences = settings.tumbling_sequences = 10;
  settings.frames = kFrames;
  settings.baseline_sequences = 0;
  const File file;
  {
    const sim::ShardWriter writer(file.path(),
                                  {identity_of(sim::Subject(), settings, "1.2.3"), {1, 3}, "a", "b"});
  }
  return file.content();
}

std::string records_from(Input& input) {
  std::string bytes;
  while (!input.empty()) {
    sim::SequenceResult result;
    result.sequence = input.u8() % 16U;
    const std::vector<std::uint8_t> record = sim::to_record(input.u8() % 4U == 0 ? 1 : 0, result, kFrames);
    bytes.append(record.begin(), record.end());
    if (input.u8() % 4U == 0) bytes[bytes.size() - 1 - input.u8() % record.size()] ^= 1;
  }
  return bytes;
}

std::string shard_from(Input& input) {
  static const std::string header = header_of_a_shard();
  const std::uint8_t kind = input.u8() % 3U;
  if (kind == 0) return input.text();
  return header + (kind == 1 ? input.text() : records_from(input));
}

void read(const File& file) {
  const std::string path = file.path();
  const std::size_t size = file.content().size();
  const sim::ShardContent content = sim::read_shard(path);
  require(content.size_bytes + content.dropped_bytes == size, "every byte is kept or dropped");
  for (std::size_t run = 0; run < content.done.size(); ++run) {
    std::set<std::uint32_t> read;
    sim::read_run(path, content, run, [&](sim::SequenceResult&& result) { read.insert(result.sequence); });
    require(read == content.done[run], "every record is read once");
  }
  require(sim::cut_to_whole_records(path) == content.dropped_bytes, "what is dropped is cut");
  const sim::ShardContent again = sim::read_shard(path);
  require(again.dropped_bytes == 0 && again.done == content.done, "a file that is cut is as it was");
}

}  // namespace
}  // namespace tumblesight::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  static const fuzz::File file;
  fuzz::Input input(data, size);
  file.fill(fuzz::shard_from(input));
  (void)sim::records_in(file.path());
  try {
    fuzz::read(file);
  } catch (const std::runtime_error& error) {
    const std::string message = error.what();
    fuzz::require(message.find(file.path()) != std::string::npos, "a refusal names the file");
  }
  return 0;
}
