#include "sim/recording/mcap_reader.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "gnc/numerics/crc.hpp"
#include "sim/host/text.hpp"
#include "sim/recording/mcap_format.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint64_t kRecordHead = 1 + 8;            // bytes: opcode, length
constexpr std::uint64_t kFooterContent = 8 + 8 + 4;     // bytes
constexpr std::uint64_t kMessageHead = 2 + 4 + 8 + 8;   // bytes before a message's own
constexpr std::uint64_t kIndexEntry = 8 + 8;            // bytes: time, offset
constexpr std::uint64_t kMostSchemaBytes = 256U << 20;  // each channel has a copy of its schema

template <class Number>
Number little_endian(const std::uint8_t* bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = sizeof(Number); i-- > 0;) value = (value << 8) | bytes[i];
  return static_cast<Number>(value);
}

std::string quoted(std::string_view text) {
  return "'" + shortened(std::string(text)) + "'";
}

}  // namespace

// The fields of a record, one after the other. What follows the known fields is of a later version.
class McapReader::Fields {
 public:
  Fields(const McapReader& reader, const Record& record)
      : reader_(reader), at_(record.content), end_(record.end()) {}

  template <class Number>
  Number number() {
    return little_endian<Number>(reader_.file_.bytes.get() + skip(sizeof(Number)));
  }
  std::string_view text() {
    const auto size = number<std::uint32_t>();
    return {reinterpret_cast<const char*>(reader_.file_.bytes.get() + skip(size)), size};
  }
  // Returns where the bytes are.
  std::uint64_t skip(std::uint64_t bytes) {
    if (bytes > end_ - at_) reader_.damaged(at_, "a field that exceeds its record");
    return std::exchange(at_, at_ + bytes);
  }
  // An array or a map: its elements are the next fields, and the last ones.
  void enter(std::uint64_t element_bytes) {
    const auto size = number<std::uint32_t>();
    const std::uint64_t start = skip(size);
    if (size % element_bytes != 0) reader_.damaged(start, "a list that ends within an element");
    at_ = start;
    end_ = start + size;
  }
  std::uint64_t at() const { return at_; }
  std::uint64_t left() const { return end_ - at_; }

 private:
  const McapReader& reader_;
  std::uint64_t at_, end_;
};

// A file descriptor that is closed in any case.
class McapReader::Descriptor {
 public:
  // Does not wait for the writer of a pipe.
  explicit Descriptor(const std::string& path) : fd_(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~Descriptor() {
    if (fd_ >= 0) close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

McapReader::McapReader(const std::string& path) : McapReader(mapped(path)) {}

McapReader McapReader::from_bytes(std::vector<std::uint8_t> bytes, std::string name) {
  const auto holder = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
  return McapReader(File{std::move(name), {holder, holder->data()}, holder->size()});
}

McapReader::McapReader(File file) : file_(std::move(file)) {
  require_start();
  const std::optional<Record> end = footer();
  is_whole_ = end.has_value();
  const bool has_indices = end && open_by_summary(*end);
  if (!has_indices) scan(end ? end->start : file_.size);
  is_checked_.reset(new std::atomic<bool>[contents_.chunks.size()]);
  for (std::size_t i = 0; i < contents_.chunks.size(); ++i) is_checked_[i] = !has_indices;
}

McapReader::File McapReader::mapped(const std::string& path) {
  const auto descriptor = std::make_shared<const Descriptor>(path);
  struct stat state {};
  if (descriptor->get() < 0 || fstat(descriptor->get(), &state) != 0)
    fail(path, std::string("cannot be read: ") + std::strerror(errno) + "; give an existing file");
  if (!S_ISREG(state.st_mode)) fail(path, "is not a file; give the path of an MCAP file");
  if (state.st_size == 0) fail(path, "is empty; give a file that has a recording");
  const auto size = static_cast<std::size_t>(state.st_size);
  void* memory = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor->get(), 0);
  if (memory == MAP_FAILED) fail(path, std::string("cannot be mapped into memory: ") + std::strerror(errno));
  const auto unmap = [size](std::uint8_t* bytes) { munmap(bytes, size); };
  return {path, std::shared_ptr<std::uint8_t>(static_cast<std::uint8_t*>(memory), unmap), size, descriptor};
}

// Beyond the end of the file the mapping has no memory.
void McapReader::require_same_length() const {
  struct stat state {};
  if (!file_.descriptor || fstat(file_.descriptor->get(), &state) != 0) return;
  if (static_cast<std::uint64_t>(state.st_size) < file_.size)
    fail(file_.name, "another program has made it shorter since it was opened; open it again");
}

void McapReader::fail(const std::string& name, const std::string& what) {
  throw std::runtime_error("recording '" + name + "': " + what);
}

void McapReader::damaged(std::uint64_t at, const std::string& what) const {
  fail(file_.name, "byte " + std::to_string(at) + ": " + what +
                       ": the file is damaged; `mcap recover FILE -o COPY` of the mcap tool writes a copy of "
                       "what can be read");
}

void McapReader::require_start() const {
  const std::uint8_t* bytes = file_.bytes.get();
  const std::uint64_t compared = std::min<std::uint64_t>(file_.size, kMcapMagic.size());
  if (compared == 0) fail(file_.name, "is empty; give a file that has a recording");
  if (!std::equal(bytes, bytes + compared, kMcapMagic.begin()))
    fail(file_.name, "is not an MCAP file: it begins with " +
                         quoted({reinterpret_cast<const char*>(bytes), compared}) +
                         "; give a file that `tumblesight simulate --mcap` or another program has recorded");
  const std::optional<Record> header = record_at(kMcapMagic.size(), file_.size);
  if (header && header->opcode != kMcapHeader) damaged(header->start, "a record before the header");
  if (!header)
    fail(file_.name,
         "byte " + std::to_string(file_.size) +
             ": the file ends within its header: its writer was killed before it wrote a message; "
             "record again");
}

std::optional<McapReader::Record> McapReader::record_at(std::uint64_t at, std::uint64_t end) const {
  if (at > end || end - at < kRecordHead) return std::nullopt;
  const std::uint8_t* head = file_.bytes.get() + at;
  const auto size = little_endian<std::uint64_t>(head + 1);
  if (head[0] == kMcapInvalid || size > end - at - kRecordHead) return std::nullopt;
  return Record{head[0], at, at + kRecordHead, size};
}

McapReader::Record McapReader::required_record(std::uint64_t at, std::uint64_t end) const {
  const std::optional<Record> record = record_at(at, end);
  if (!record) damaged(at, "no complete record begins here");
  return *record;
}

// Nothing: the file has no end. A footer stands at a fixed distance from the end.
std::optional<McapReader::Record> McapReader::footer() const {
  const std::uint64_t tail = kRecordHead + kFooterContent + kMcapMagic.size();
  if (file_.size < kMcapMagic.size() + tail) return std::nullopt;
  const std::uint64_t magic = file_.size - kMcapMagic.size();
  if (!std::equal(kMcapMagic.begin(), kMcapMagic.end(), file_.bytes.get() + magic)) return std::nullopt;
  const std::optional<Record> footer = record_at(file_.size - tail, magic);
  if (!footer || footer->opcode != kMcapFooter || footer->size != kFooterContent) return std::nullopt;
  return footer;
}

std::uint32_t McapReader::crc_of(std::uint64_t start, std::uint64_t end) const {
  return gnc::crc32(file_.bytes.get() + start, end - start);
}

bool McapReader::open_by_summary(const Record& footer) {
  const std::uint64_t start = summary_start(footer);
  std::map<std::uint8_t, std::vector<Record>> groups;
  for (std::uint64_t at = start; at < footer.start;) {
    const Record record = required_record(at, footer.start);
    groups[record.opcode].push_back(record);
    at = record.end();
  }
  for (const Record& record : groups[kMcapSchema]) add_schema(record);
  for (const Record& record : groups[kMcapChannel])
    if (!add_channel(record)) return false;
  // The statistics tell whether the summary has all channels and indices: each kind is optional.
  if (groups[kMcapStatistics].empty()) return false;
  Fields statistics(*this, groups[kMcapStatistics].front());
  const auto messages = statistics.number<std::uint64_t>();
  statistics.skip(sizeof(std::uint16_t));  // schemas
  const auto channels = statistics.number<std::uint32_t>();
  statistics.skip(2 * sizeof(std::uint32_t));  // attachments, metadata
  const auto chunks = statistics.number<std::uint32_t>();
  if (channels != contents_.channels.size() || chunks != groups[kMcapChunkIndex].size()) return false;
  return read_chunk_indices(std::move(groups[kMcapChunkIndex]), footer.start, messages);
}

// That of the footer if there is no summary. The checksum covers the footer up to itself.
std::uint64_t McapReader::summary_start(const Record& footer) const {
  Fields fields(*this, footer);
  const auto announced = fields.number<std::uint64_t>();
  fields.skip(sizeof(std::uint64_t));  // where the offsets of the groups start
  const std::uint64_t covered = fields.at();
  const auto crc = fields.number<std::uint32_t>();
  const std::uint64_t start = announced == 0 ? footer.start : announced;
  if (start < kMcapMagic.size() || start > footer.start)
    damaged(footer.start, "a footer that places the summary outside the file");
  if (crc != 0 && crc != crc_of(start, covered)) damaged(start, "a summary that does not fit its checksum");
  return start;
}

// `messages`: as the statistics say.
bool McapReader::read_chunk_indices(std::vector<Record> chunk_indices, std::uint64_t end,
                                    std::uint64_t messages) {
  // Message indices may overlap: without this bound, they could announce more than the memory holds.
  if (messages > file_.size / (kRecordHead + kMessageHead)) return false;
  constexpr std::uint64_t kTimes = 8 + 8;  // bytes before the place of the chunk
  const auto place = [&](const Record& chunk_index) {
    Fields fields(*this, chunk_index);
    fields.skip(kTimes);
    return fields.number<std::uint64_t>();
  };
  std::sort(chunk_indices.begin(), chunk_indices.end(),
            [&](const Record& a, const Record& b) { return place(a) < place(b); });
  for (const Record& chunk_index : chunk_indices) {
    Fields fields(*this, chunk_index);
    fields.skip(kTimes);
    const auto start = fields.number<std::uint64_t>(), size = fields.number<std::uint64_t>();
    const bool overlaps = !contents_.chunks.empty() && start < contents_.chunks.back().end();
    const std::optional<Record> chunk = overlaps ? std::nullopt : record_at(start, end);
    if (!chunk || chunk->opcode != kMcapChunk || chunk->end() - start != size)
      damaged(chunk_index.start, "an index of a chunk that is not there");
    contents_.chunks.push_back(chunk_of(*chunk));
    if (!read_message_indices(chunk_index, end, messages)) return false;
  }
  return messages == 0;
}

// Of the last chunk.
bool McapReader::read_message_indices(const Record& chunk_index, std::uint64_t end,
                                      std::uint64_t& messages_left) {
  Fields fields(*this, chunk_index);
  fields.skip(8 + 8 + 8 + 8);  // times and place of the chunk
  fields.enter(sizeof(McapId) + sizeof(std::uint64_t));
  while (fields.left() > 0) {
    const auto channel = fields.number<McapId>();
    const auto at = fields.number<std::uint64_t>();
    if (contents_.entries.count(channel) == 0) return false;
    const std::optional<Record> index = record_at(at, end);
    if (!index || index->opcode != kMcapMessageIndex)
      damaged(chunk_index.start, "a chunk index that names a message index that is not there");
    if (!read_message_index(*index, channel, messages_left)) return false;
  }
  return true;
}

bool McapReader::read_message_index(const Record& index, McapId channel, std::uint64_t& messages_left) {
  Fields fields(*this, index);
  if (fields.number<McapId>() != channel) damaged(index.start, "a message index of another channel");
  fields.enter(kIndexEntry);
  const std::uint64_t count = fields.left() / kIndexEntry;
  if (count > messages_left) return false;
  messages_left -= count;
  const std::uint64_t chunk = contents_.chunks.size() - 1, chunk_size = contents_.chunks.back().size;
  std::vector<Entry>& entries = contents_.entries[channel].entries;
  if (!entries.empty() && entries.back().chunk == chunk)
    damaged(index.start, "a second message index of the same channel and chunk");
  const auto before = static_cast<std::ptrdiff_t>(entries.size());
  while (fields.left() > 0) {
    const auto time_ns = fields.number<std::uint64_t>(), offset = fields.number<std::uint64_t>();
    if (offset >= chunk_size) damaged(index.start, "a message index that points outside its chunk");
    entries.push_back({time_ns, chunk, offset});
  }
  // The index may be in the order of time.
  std::sort(entries.begin() + before, entries.end(),
            [](const Entry& a, const Entry& b) { return a.offset < b.offset; });
  const auto is_same = [](const Entry& a, const Entry& b) { return a.offset == b.offset; };
  if (std::adjacent_find(entries.begin() + before, entries.end(), is_same) != entries.end())
    damaged(index.start, "a message index that has a message twice");
  return true;
}

// Message indices are not used here: those of the last chunks may be missing.
void McapReader::scan(std::uint64_t end) {
  contents_ = {};
  for (std::uint64_t at = kMcapMagic.size(); at < end;) {
    const std::optional<Record> record = record_at(at, end);
    if (!record && !is_whole_) return;  // the writer was killed here
    if (!record) damaged(at, "no complete record begins here");
    if (record->opcode == kMcapDataEnd) return require_data_checksum(*record);
    if (record->opcode == kMcapChunk)
      scan_chunk(*record);
    else
      add(*record, kNoChunk, 0);
    at = record->end();
  }
}

void McapReader::scan_chunk(const Record& record) {
  const Chunk chunk = chunk_of(record);
  require_checksum(chunk);  // else damaged lengths would hide messages
  const std::uint64_t end = chunk.end();
  contents_.chunks.push_back(chunk);
  for (std::uint64_t at = chunk.records; at < end;) {
    const Record inner = required_record(at, end);
    add(inner, contents_.chunks.size() - 1, chunk.records);
    at = inner.end();
  }
}

// The only checksum of messages outside of chunks.
void McapReader::require_data_checksum(const Record& data_end) const {
  const auto crc = Fields(*this, data_end).number<std::uint32_t>();
  if (crc != 0 && crc != crc_of(0, data_end.start))
    damaged(data_end.start, "data that do not fit their checksum");
}

// Other records, as attachments and metadata, are skipped.
void McapReader::add(const Record& record, std::uint64_t chunk, std::uint64_t chunk_records) {
  if (record.opcode == kMcapSchema) add_schema(record);
  if (record.opcode == kMcapChannel && !add_channel(record))
    damaged(record.start, "a channel of a schema that is not there");
  if (record.opcode == kMcapMessage) add_message(record, chunk, chunk_records);
}

void McapReader::add_schema(const Record& record) {
  Fields fields(*this, record);
  const auto id = fields.number<McapId>();
  const std::string_view name = fields.text(), encoding = fields.text(), text = fields.text();
  if (id == 0) damaged(record.start, "a schema with the number 0, which stands for none");
  const auto [place, is_new] = contents_.schemas.try_emplace(id, Schema{name, encoding, text});
  const Schema& known = place->second;
  if (!is_new && (known.name != name || known.encoding != encoding || known.text != text))
    damaged(record.start, "another schema with the number " + std::to_string(id));
}

bool McapReader::add_channel(const Record& record) {
  Fields fields(*this, record);
  const auto id = fields.number<McapId>(), schema_id = fields.number<McapId>();
  const std::string_view topic = fields.text(), encoding = fields.text();
  const auto known = contents_.entries.find(id);
  if (known != contents_.entries.end()) {
    const Channel& before = contents_.channels[known->second.place];
    if (known->second.schema != schema_id || before.topic != topic || before.encoding != encoding)
      damaged(record.start, "another channel with the number " + std::to_string(id));
    return true;
  }
  const auto found = contents_.schemas.find(schema_id);
  if (schema_id != 0 && found == contents_.schemas.end()) return false;
  const Schema schema = schema_id == 0 ? Schema{} : found->second;
  contents_.schema_bytes += schema.name.size() + schema.encoding.size() + schema.text.size();
  if (contents_.schema_bytes > kMostSchemaBytes)
    fail(file_.name,
         "the schemas of all channels have more than 256 MiB; keep fewer channels with `mcap filter`");
  contents_.entries[id] = {schema_id, contents_.channels.size(), {}};
  contents_.channels.push_back({id, std::string(topic), std::string(encoding), std::string(schema.name),
                                std::string(schema.encoding), std::string(schema.text)});
  return true;
}

void McapReader::add_message(const Record& record, std::uint64_t chunk, std::uint64_t chunk_records) {
  Fields fields(*this, record);
  const auto channel = fields.number<McapId>();
  fields.skip(sizeof(std::uint32_t));  // its number
  const auto time_ns = fields.number<std::uint64_t>();
  fields.skip(sizeof(std::uint64_t));  // when it was sent
  const auto found = contents_.entries.find(channel);
  if (found == contents_.entries.end())
    damaged(record.start, "a message of channel " + std::to_string(channel) + ", which is not there");
  found->second.entries.push_back({time_ns, chunk, record.start - chunk_records});
}

McapReader::Chunk McapReader::chunk_of(const Record& record) const {
  Fields fields(*this, record);
  fields.skip(8 + 8);  // first and last time
  const auto size = fields.number<std::uint64_t>();
  const auto crc = fields.number<std::uint32_t>();
  const std::string_view compression = fields.text();
  if (!compression.empty())
    fail(file_.name,
         "the chunk at byte " + std::to_string(record.start) + " is compressed with " + quoted(compression) +
             ": only files without compression can be read; `mcap decompress FILE -o COPY` of the "
             "mcap tool writes such a copy");
  const auto stored = fields.number<std::uint64_t>();
  const std::uint64_t records = fields.skip(stored);
  if (stored != size) damaged(record.start, "a chunk that does not have the size that it announces");
  return {record.start, records, size, crc};
}

void McapReader::require_checksum(const Chunk& chunk) const {
  if (chunk.crc != 0 && chunk.crc != crc_of(chunk.records, chunk.end()))
    damaged(chunk.start, "a chunk that does not fit its checksum");
}

const McapReader::Channel* McapReader::find(const std::string& topic) const {
  for (const Channel& channel : contents_.channels)
    if (channel.topic == topic) return &channel;
  return nullptr;
}

const std::vector<McapReader::Entry>& McapReader::entries(McapId channel) const {
  const auto found = contents_.entries.find(channel);
  if (found == contents_.entries.end()) throw std::logic_error("entries of an unknown channel");
  return found->second.entries;
}

McapReader::Message McapReader::read(McapId channel, const Entry& entry) const {
  require_same_length();
  std::uint64_t start = entry.offset, end = file_.size;
  if (entry.chunk != kNoChunk) {
    if (entry.chunk >= contents_.chunks.size()) throw std::logic_error("an entry of an unknown chunk");
    const Chunk& chunk = contents_.chunks[entry.chunk];
    if (entry.offset > chunk.size) throw std::logic_error("an entry outside its chunk");
    if (!is_checked_[entry.chunk]) {  // for two threads at once too: both find the same
      require_checksum(chunk);
      is_checked_[entry.chunk] = true;
    }
    start += chunk.records;
    end = chunk.end();
  }
  const std::optional<Record> record = record_at(start, end);
  if (!record || record->opcode != kMcapMessage)
    damaged(start, "no message, although the index announces one");
  Fields fields(*this, *record);
  const auto its_channel = fields.number<McapId>();
  fields.skip(sizeof(std::uint32_t));  // its number
  const auto time_ns = fields.number<std::uint64_t>();
  fields.skip(sizeof(std::uint64_t));  // when it was sent
  if (its_channel != channel || time_ns != entry.time_ns)
    damaged(start, "a message of another channel or time than the index announces");
  return {file_.bytes.get() + fields.at(), fields.left(), time_ns};
}

}  // namespace tumblesight::sim
