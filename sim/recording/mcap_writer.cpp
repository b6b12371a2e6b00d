#include "sim/recording/mcap_writer.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "sim/host/place.hpp"
#include "sim/recording/mcap_format.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::size_t kChunkBytes = 1 << 20;
constexpr std::chrono::seconds kLongestChunk{1};
constexpr std::size_t kMostIds = 65'535;

// Content of a record. Numbers are little-endian; texts and maps begin with their length in bytes.
class Content {
 public:
  template <class Number>
  Content& number(Number value) {
    for (std::size_t i = 0; i < sizeof value; ++i)
      bytes_.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i)));
    return *this;
  }
  Content& text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    return *this;
  }
  Content& raw(const std::uint8_t* bytes, std::size_t size) {
    bytes_.insert(bytes_.end(), bytes, bytes + size);
    return *this;
  }
  Content& map(const std::map<McapId, std::uint64_t>& numbers) {
    number(static_cast<std::uint32_t>(numbers.size() * (sizeof(McapId) + sizeof(std::uint64_t))));
    for (const auto& [key, value] : numbers) number(key).number(value);
    return *this;
  }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

  std::vector<std::uint8_t> as(McapOpcode opcode) const {
    Content whole;
    whole.number(static_cast<std::uint8_t>(opcode)).number(std::uint64_t{bytes_.size()});
    whole.raw(bytes_.data(), bytes_.size());
    return whole.bytes_;
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace

McapWriter::McapWriter(std::string path, const std::string& library)
    : path_(std::move(path)), file_(nullptr, &std::fclose) {
  const Place place(path_);
  if (!place.fault().empty()) fail(place.fault());
  open_alone(place);
  struct stat status {};
  if (fstat(fileno(file_.get()), &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0)
    replace(place);
  put({kMcapMagic.begin(), kMcapMagic.end()});
  put(Content().text("").text(library).as(kMcapHeader));
}

// Not emptied before it is ours alone. A device can be neither locked nor emptied.
void McapWriter::open_alone(const Place& place) {
  if (place.type() == S_IFIFO) fail("is a pipe, which cannot be a recording; give the path of a file");
  int file = -1;
  try {
    file = open_place(place, O_WRONLY | O_APPEND);
  } catch (const std::runtime_error& error) {
    fail(std::string("cannot be written: ") + error.what());
  }
  file_.reset(fdopen(file, "ab"));
  // Every record goes to the file at once, so that none is left over for the end after an error.
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);
  struct stat status {};
  if (fstat(file, &status) == 0 && S_ISFIFO(status.st_mode)) fail("has become a pipe; give another path");
  if (flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    fail("another program is writing it; give another name");
}

// Another file takes the place of the old one, which a console may still show. Where that cannot be, it is
// emptied.
void McapWriter::replace(const Place& place) {
  if (!place.is_of_kernel() && unlinkat(place.folder(), place.name().c_str(), 0) == 0)
    return open_alone(place);
  if (ftruncate(fileno(file_.get()), 0) != 0) fail(std::string("cannot be emptied: ") + std::strerror(errno));
}

McapWriter::~McapWriter() {
  try {
    close();
  } catch (const std::runtime_error&) {  // who wants to know calls close()
  }
}

void McapWriter::fail(const std::string& what) const {
  throw std::runtime_error("recording '" + path_ + "': " + what);
}

void McapWriter::put(const Bytes& bytes) {
  // After a part of a record nothing may follow, or every offset behind it is wrong.
  if (has_failed_) fail("an earlier part of it could not be written");
  has_failed_ = std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size();
  if (has_failed_) {
    const std::string cause = std::strerror(errno);
    // A part of a record is of no use. What is before it can be read.
    const bool is_whole = ftruncate(fileno(file_.get()), static_cast<off_t>(position_)) == 0;
    fail("cannot be written: " + cause + "; free space on the disk and run again" +
         (is_whole && !chunks_.empty() ? " (what was written until then can be read)" : ""));
  }
  crc_.add(bytes.data(), bytes.size());
  position_ += bytes.size();
}

McapId McapWriter::add_schema(const std::string& name, const std::string& encoding, std::string_view text) {
  if (schemas_.size() == kMostIds) fail("more than 65,535 schemas");
  const auto id = static_cast<McapId>(schemas_.size() + 1);
  schemas_.push_back(Content().number(id).text(name).text(encoding).text(text).as(kMcapSchema));
  put(schemas_.back());
  return id;
}

McapId McapWriter::add_channel(const std::string& topic, const std::string& encoding, McapId schema) {
  if (channels_.size() == kMostIds) fail("more than 65,535 channels");
  const auto id = static_cast<McapId>(channels_.size() + 1);
  channels_[id] = {};
  channel_records_.push_back(
      Content().number(id).number(schema).text(topic).text(encoding).map({}).as(kMcapChannel));
  put(channel_records_.back());
  return id;
}

void McapWriter::write(McapId channel, std::int64_t time_ns, std::string_view text) {
  write(channel, time_ns, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

void McapWriter::write(McapId channel, std::int64_t time_ns, const std::uint8_t* bytes, std::size_t size) {
  const auto found = channels_.find(channel);
  if (found == channels_.end()) fail("a message of an unknown channel");
  if (time_ns < 0) fail("a message at " + std::to_string(time_ns) + " ns: the format has no time before 0");
  const auto time = static_cast<std::uint64_t>(time_ns);
  if (chunk_.empty()) {
    chunk_first_ns_ = chunk_last_ns_ = time;
    chunk_began_ = std::chrono::steady_clock::now();
  }
  found->second.in_chunk.push_back({time, chunk_.size()});
  const Bytes record = Content()
                           .number(channel)
                           .number(found->second.sequence++)
                           .number(time)
                           .number(time)
                           .raw(bytes, size)
                           .as(kMcapMessage);
  chunk_.insert(chunk_.end(), record.begin(), record.end());
  chunk_first_ns_ = std::min(chunk_first_ns_, time);
  chunk_last_ns_ = std::max(chunk_last_ns_, time);
  ++messages_;
  if (chunk_.size() >= kChunkBytes) write_chunk();
  write_due();
}

void McapWriter::write_due() {
  if (!chunk_.empty() && std::chrono::steady_clock::now() - chunk_began_ >= kLongestChunk) write_chunk();
}

void McapWriter::write_chunk() {
  if (chunk_.empty()) return;
  ChunkIndex index{chunk_first_ns_, chunk_last_ns_, position_, 0, chunk_.size(), {}, 0};
  put(Content()
          .number(chunk_first_ns_)
          .number(chunk_last_ns_)
          .number(std::uint64_t{chunk_.size()})
          .number(gnc::crc32(chunk_.data(), chunk_.size()))
          .text("")
          .number(std::uint64_t{chunk_.size()})
          .raw(chunk_.data(), chunk_.size())
          .as(kMcapChunk));
  index.length = position_ - index.start;
  const std::uint64_t indices_start = position_;
  for (auto& [id, channel] : channels_) {
    if (channel.in_chunk.empty()) continue;
    index.index_offsets[id] = position_;
    Content entries;
    for (const IndexEntry& entry : channel.in_chunk) entries.number(entry.time_ns).number(entry.offset);
    put(Content()
            .number(id)
            .number(static_cast<std::uint32_t>(entries.bytes().size()))
            .raw(entries.bytes().data(), entries.bytes().size())
            .as(kMcapMessageIndex));
    channel.in_chunk.clear();
  }
  index.index_length = position_ - indices_start;
  first_ns_ = chunks_.empty() ? chunk_first_ns_ : std::min(first_ns_, chunk_first_ns_);
  last_ns_ = std::max(last_ns_, chunk_last_ns_);
  chunks_.push_back(index);
  chunk_.clear();
}

McapWriter::Bytes McapWriter::statistics() const {
  std::map<McapId, std::uint64_t> counts;
  for (const auto& [id, channel] : channels_)
    if (channel.sequence > 0) counts[id] = channel.sequence;
  return Content()
      .number(messages_)
      .number(static_cast<std::uint16_t>(schemas_.size()))
      .number(static_cast<std::uint32_t>(channels_.size()))
      .number(std::uint32_t{0})  // attachments
      .number(std::uint32_t{0})  // metadata
      .number(static_cast<std::uint32_t>(chunks_.size()))
      .number(first_ns_)
      .number(last_ns_)
      .map(counts)
      .as(kMcapStatistics);
}

void McapWriter::write_summary() {
  const std::uint64_t start = position_;
  crc_ = {};
  Bytes offsets;
  const auto put_group = [&](McapOpcode opcode, const std::vector<Bytes>& records) {
    if (records.empty()) return;
    const std::uint64_t group_start = position_;
    for (const Bytes& one : records) put(one);
    const Bytes offset = Content()
                             .number(static_cast<std::uint8_t>(opcode))
                             .number(group_start)
                             .number(position_ - group_start)
                             .as(kMcapSummaryOffset);
    offsets.insert(offsets.end(), offset.begin(), offset.end());
  };
  std::vector<Bytes> indices;
  for (const ChunkIndex& chunk : chunks_) {
    indices.push_back(Content()
                          .number(chunk.first_ns)
                          .number(chunk.last_ns)
                          .number(chunk.start)
                          .number(chunk.length)
                          .map(chunk.index_offsets)
                          .number(chunk.index_length)
                          .text("")
                          .number(chunk.size)
                          .number(chunk.size)
                          .as(kMcapChunkIndex));
  }
  put_group(kMcapSchema, schemas_);
  put_group(kMcapChannel, channel_records_);
  put_group(kMcapStatistics, {statistics()});
  put_group(kMcapChunkIndex, indices);
  const std::uint64_t offsets_start = position_;
  put(offsets);
  // The checksum covers the footer up to itself.
  Bytes footer = Content().number(start).number(offsets_start).number(std::uint32_t{0}).as(kMcapFooter);
  footer.resize(footer.size() - sizeof(std::uint32_t));
  put(footer);
  put(Content().number(crc_.value()).bytes());
}

void McapWriter::close() {
  if (!file_) return;
  struct Release {
    McapWriter& writer;
    ~Release() { writer.file_.reset(); }
  } release{*this};
  write_chunk();
  put(Content().number(crc_.value()).as(kMcapDataEnd));
  write_summary();
  put({kMcapMagic.begin(), kMcapMagic.end()});
}

}  // namespace tumblesight::sim
