#include "sim/recording/mcap_reader.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>
#include <utility>

#include "gnc/numerics/crc.hpp"
#include "tests/support/hostile_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tumblesight::sim {
namespace {

// Files are made here byte by byte by the words of mcap.dev/spec, with no code of the writer.
const std::string kMagic("\x89MCAP0\r\n", 8);

enum Opcode : std::uint8_t {
  kHeader = 1,
  kFooter = 2,
  kSchema = 3,
  kChannel = 4,
  kMessage = 5,
  kChunk = 6,
  kMessageIndex = 7,
  kChunkIndex = 8,
  kAttachment = 9,
  kStatistics = 11,
  kMetadata = 12,
  kDataEnd = 15,
  kOfUsers = 0x80,
};

template <class Number>
std::string number(Number value) {
  std::string bytes;
  for (std::size_t i = 0; i < sizeof value; ++i)
    bytes += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i));
  return bytes;
}
std::string id(int value) {
  return number(static_cast<std::uint16_t>(value));
}
std::string u32(std::uint64_t value) {
  return number(static_cast<std::uint32_t>(value));
}
std::string u64(std::uint64_t value) {
  return number(value);
}
std::string text(const std::string& text) {
  return u32(text.size()) + text;
}
std::string record(std::uint8_t opcode, const std::string& content) {
  return number(opcode) + u64(content.size()) + content;
}
std::uint32_t crc_of(const std::string& bytes) {
  return gnc::crc32(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

std::string header() {
  return kMagic + record(kHeader, text("") + text("test"));
}
std::string schema(int number = 1, const std::string& name = "A") {
  return record(kSchema, id(number) + text(name) + text("jsonschema") + text("{}"));
}
std::string channel(int number, const std::string& topic, int schema = 1) {
  return record(kChannel, id(number) + id(schema) + text(topic) + text("json") + u32(0));
}
std::string message(int channel, std::uint64_t time_ns, const std::string& data) {
  return record(kMessage, id(channel) + u32(0) + u64(time_ns) + u64(time_ns) + data);
}
std::string chunk(const std::string& records, const std::string& compression = "") {
  return record(kChunk, u64(0) + u64(0) + u64(records.size()) + u32(crc_of(records)) + text(compression) +
                            u64(records.size()) + records);
}
std::string message_index(int channel, const std::string& entries) {
  return record(kMessageIndex, id(channel) + text(entries));
}
std::string statistics(std::uint64_t messages, std::uint32_t channels, std::uint32_t chunks) {
  return record(kStatistics, u64(messages) + id(1) + u32(channels) + u32(0) + u32(0) + u32(chunks) + u64(0) +
                                 u64(0) + u32(0));
}
// `map`: channels and the offsets of their message indices.
std::string chunk_index(std::uint64_t start, std::uint64_t size, const std::string& map) {
  return record(kChunkIndex,
                u64(0) + u64(0) + u64(start) + u64(size) + text(map) + u64(0) + text("") + u64(0) + u64(0));
}
// Adds the end: with the summary, or without one.
std::string ended(const std::string& data, const std::string& summary = "") {
  const std::string whole = data + record(kDataEnd, u32(crc_of(data)));
  const std::string footer =
      number<std::uint8_t>(kFooter) + u64(20) + u64(summary.empty() ? 0 : whole.size()) + u64(0);
  return whole + summary + footer + u32(crc_of(summary + footer)) + kMagic;
}
// The smallest summary of a file of one chunk.
std::string ended(const std::string& before, const std::string& one_chunk, const std::string& index,
                  std::uint64_t messages) {
  const std::string map = id(1) + u64(before.size() + one_chunk.size());
  return ended(before + one_chunk + index, schema() + channel(1, "/a") + statistics(messages, 1, 1) +
                                               chunk_index(before.size(), one_chunk.size(), map));
}

const std::string kStart = header() + schema() + channel(1, "/a");

struct Read {
  std::string topic;
  std::uint64_t time_ns;
  std::string data;
  bool operator==(const Read& other) const {
    return topic == other.topic && time_ns == other.time_ns && data == other.data;
  }
};
std::ostream& operator<<(std::ostream& out, const Read& read) {
  return out << read.topic << ' ' << read.time_ns << ' ' << read.data;
}

McapReader reader_of(const std::string& bytes) {
  return McapReader::from_bytes({bytes.begin(), bytes.end()}, "a.mcap");
}
// Channel by channel.
std::vector<Read> messages_of(const McapReader& reader) {
  std::vector<Read> all;
  for (const McapReader::Channel& channel : reader.channels()) {
    for (const McapReader::Entry& entry : reader.entries(channel.id)) {
      const McapReader::Message message = reader.read(channel.id, entry);
      EXPECT_EQ(message.time_ns, entry.time_ns);
      all.push_back({channel.topic, message.time_ns, {message.bytes, message.bytes + message.size}});
    }
  }
  return all;
}
std::string refusal_of(const std::string& bytes) {
  try {
    (void)messages_of(reader_of(bytes));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}
void expect_refusal(const std::string& bytes, const std::string& expected) {
  const std::string refusal = refusal_of(bytes);
  EXPECT_EQ(refusal.find("recording 'a.mcap': "), 0U) << refusal;
  EXPECT_NE(refusal.find(expected), std::string::npos) << refusal;
}

class McapReading : public testing::Test {
 protected:
  std::string written_by_the_writer() const {
    McapWriter writer(path_, "test");
    const McapId schema = writer.add_schema("Number", "jsonschema", R"({"type":"object"})");
    const McapId first = writer.add_channel("/first", "json", schema);
    const McapId second = writer.add_channel("/second", "cdr", schema);
    for (int i = 0; i < 4; ++i) writer.write(first, 1000 - i, "one" + std::to_string(i));
    writer.write(second, 7, R"({"a":1})");
    writer.close();
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  TemporaryFolder folder_;
  std::string path_ = folder_.path("run.mcap");
};

// A file of two chunks and two channels, with all indices.
struct TwoChunks {
  TwoChunks() {
    bytes = header() + schema() + channel(1, "/a") + channel(2, "/b");
    std::string indices;
    for (int i = 0; i < 2; ++i) {
      const auto time_ns = static_cast<std::uint64_t>(10 * i);
      const std::string a = message(1, time_ns, "a" + std::to_string(i)), b = message(2, time_ns, "b");
      const std::uint64_t start = bytes.size();
      bytes += chunk(a + b);
      const std::uint64_t end = bytes.size();
      chunk_ends.push_back(end);
      const std::string index = message_index(1, u64(time_ns) + u64(0));
      bytes += index + message_index(2, u64(time_ns) + u64(a.size()));
      indices += chunk_index(start, end - start, id(1) + u64(end) + id(2) + u64(end + index.size()));
    }
    bytes = ended(bytes, schema() + channel(1, "/a") + channel(2, "/b") + statistics(4, 2, 2) + indices);
  }
  static std::vector<Read> messages(std::size_t chunks) {
    if (chunks == 0) return {};
    if (chunks == 1) return {{"/a", 0, "a0"}, {"/b", 0, "b"}};
    return {{"/a", 0, "a0"}, {"/a", 10, "a1"}, {"/b", 0, "b"}, {"/b", 10, "b"}};
  }

  std::string bytes;
  std::vector<std::uint64_t> chunk_ends;
};

// What the writer wrote is read: channels with their schemas, and messages in their order.
TEST_F(McapReading, HasWhatWasWritten) {
  McapWriter writer(path_, "test");
  const McapId schema = writer.add_schema("Number", "jsonschema", R"({"type":"object"})");
  const McapId first = writer.add_channel("/first", "json", schema);
  const McapId second = writer.add_channel("/second", "cdr", schema);
  const std::string large(400'000, 'x');  // three make a chunk
  for (int i = 0; i < 10; ++i) writer.write(first, 1000 - i, large + std::to_string(i));
  writer.write(second, 7, "");
  writer.close();
  const McapReader reader(path_);
  EXPECT_TRUE(reader.is_whole());
  ASSERT_EQ(reader.channels().size(), 2U);
  const McapReader::Channel* channel = reader.find("/second");
  ASSERT_NE(channel, nullptr);
  EXPECT_EQ(channel->id, second);
  EXPECT_EQ(channel->encoding, "cdr");
  EXPECT_EQ(channel->schema_name, "Number");
  EXPECT_EQ(channel->schema_encoding, "jsonschema");
  EXPECT_EQ(channel->schema_text, R"({"type":"object"})");
  EXPECT_EQ(reader.find("/third"), nullptr);
  ASSERT_EQ(reader.entries(first).size(), 10U);
  EXPECT_EQ(reader.entries(first)[2].chunk, 0U);
  EXPECT_EQ(reader.entries(first)[3].chunk, 1U);
  std::vector<Read> expected;
  for (std::uint64_t i = 0; i < 10; ++i) expected.push_back({"/first", 1000 - i, large + std::to_string(i)});
  expected.push_back({"/second", 7, ""});
  EXPECT_TRUE(messages_of(reader) == expected);
}

// A file without messages has its channels.
TEST_F(McapReading, OfNoMessagesHasTheChannels) {
  McapWriter writer(path_, "test");
  const McapId channel = writer.add_channel("/a", "json", writer.add_schema("A", "jsonschema", "{}"));
  writer.close();
  const McapReader reader(path_);
  EXPECT_TRUE(reader.is_whole());
  ASSERT_EQ(reader.channels().size(), 1U);
  EXPECT_TRUE(reader.entries(channel).empty());
}

// Several threads may read messages of the same chunks at once.
TEST_F(McapReading, InThreadsGivesTheSame) {
  const McapReader reader = reader_of(TwoChunks().bytes);
  std::vector<std::vector<Read>> all(4);
  std::vector<std::thread> threads;
  for (std::vector<Read>& one : all) threads.emplace_back([&] { one = messages_of(reader); });
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<Read>& one : all) EXPECT_EQ(one, TwoChunks::messages(2));
}

// A file that was cut at any byte has the messages of its complete chunks, or is refused as too short.
TEST_F(McapReading, OfAFileCutAnywhereHasItsCompleteChunks) {
  const TwoChunks file;
  for (std::size_t size = 0; size <= file.bytes.size(); ++size) {
    const std::string bytes = file.bytes.substr(0, size);
    if (size < header().size()) {
      expect_refusal(bytes, size == 0 ? "is empty" : "ends within its header");
      continue;
    }
    const McapReader reader = reader_of(bytes);
    const std::size_t chunks =
        (size >= file.chunk_ends[0] ? 1U : 0U) + (size >= file.chunk_ends[1] ? 1U : 0U);
    EXPECT_EQ(reader.is_whole(), size == file.bytes.size()) << size;
    EXPECT_EQ(messages_of(reader), TwoChunks::messages(chunks)) << size;
  }
}

// The same for the writer's own file, which has one chunk.
TEST_F(McapReading, OfAFileOfTheWriterCutAnywhereHasAllOrNothing) {
  const std::string whole = written_by_the_writer();
  const std::vector<Read> expected = messages_of(reader_of(whole));
  ASSERT_EQ(expected.size(), 5U);
  std::size_t complete = 0;
  for (std::size_t size = header().size(); size < whole.size(); ++size) {
    const McapReader reader = reader_of(whole.substr(0, size));
    const std::vector<Read> messages = messages_of(reader);
    EXPECT_FALSE(reader.is_whole());
    EXPECT_TRUE(messages.empty() || messages == expected) << size;
    complete += messages.empty() ? 0U : 1U;
  }
  EXPECT_GT(complete, 0U);
}

// Whatever byte of a whole file is damaged: the messages are the same, or the file is refused by name.
TEST_F(McapReading, OfADamagedFileIsRefusedOrTheSame) {
  const std::string in_chunk = ended(header() + chunk(schema() + channel(1, "/a") + message(1, 2, "x")));
  const std::string chunkless = ended(kStart + message(1, 2, "x") + message(1, 2, "y"));
  for (const std::string& whole : {TwoChunks().bytes, written_by_the_writer(), in_chunk, chunkless}) {
    const std::vector<Read> expected = messages_of(reader_of(whole));
    int refusals = 0;
    for (std::size_t at = 0; at < whole.size(); ++at) {
      for (const int flip : {0x01, 0x02, 0x08, 0x10, 0x80, 0xFF}) {
        std::string bytes = whole;
        bytes[at] = static_cast<char>(bytes[at] ^ flip);
        try {
          const McapReader reader = reader_of(bytes);
          const std::vector<Read> messages = messages_of(reader);
          EXPECT_EQ(messages, expected) << "byte " << at << " ^ " << flip;
        } catch (const std::runtime_error& error) {
          EXPECT_EQ(std::string(error.what()).find("recording 'a.mcap': "), 0U) << error.what();
          ++refusals;
        }
      }
    }
    EXPECT_GT(refusals, 100);
  }
}

// Damage in one chunk is named by its place, and leaves the messages of the others.
TEST_F(McapReading, OfADamagedChunkLeavesTheOthers) {
  TwoChunks file;
  file.bytes[file.chunk_ends[0] - 1] = 'X';
  const McapReader reader = reader_of(file.bytes);
  const std::vector<McapReader::Entry>& entries = reader.entries(1);
  ASSERT_EQ(entries.size(), 2U);
  try {
    (void)reader.read(1, entries[0]);
    FAIL();
  } catch (const std::runtime_error& error) {
    const std::string expected =
        "byte " + std::to_string((kStart + channel(2, "/b")).size()) +
        ": a chunk that does not fit its checksum: the file is damaged; `mcap recover";
    EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
  }
  EXPECT_EQ(reader.read(1, entries[1]).size, 2U);
}

// Only what is stored without compression is read; the remedy is in the message.
TEST_F(McapReading, OfACompressedChunkIsRefusedWithTheRemedy) {
  for (const std::string compression : {"zstd", "lz4"}) {
    const std::string compressed = chunk(message(1, 0, "x"), compression);
    const std::string expected = "the chunk at byte " + std::to_string(kStart.size()) +
                                 " is compressed with '" + compression +
                                 "': only files without compression can be read; `mcap decompress";
    expect_refusal(kStart + compressed, expected);
    expect_refusal(ended(kStart + compressed), expected);
    expect_refusal(ended(kStart, compressed, message_index(1, u64(0) + u64(0)), 1), expected);
  }
}

// Other writers put schemas and channels into the chunks, some nowhere else.
TEST_F(McapReading, HasSchemasAndChannelsOfChunks) {
  const std::string inside = schema() + channel(1, "/a") + channel(1, "/a");
  const std::string data = header() + chunk(inside + message(1, 5, "x") + schema() + message(1, 4, "y"));
  const std::vector<Read> expected{{"/a", 5, "x"}, {"/a", 4, "y"}};
  const McapReader reader = reader_of(ended(data));
  EXPECT_TRUE(reader.is_whole());
  EXPECT_EQ(reader.channels().front().schema_name, "A");
  EXPECT_EQ(messages_of(reader), expected);
  EXPECT_EQ(messages_of(reader_of(data)), expected);
}

// A summary may lack anything: channels, statistics, indices. All messages are found.
TEST_F(McapReading, OfAnIncompleteSummaryHasAllMessages) {
  const std::string records = message(1, 5, "x") + message(1, 4, "y"), data = kStart + chunk(records);
  const std::string index = chunk_index(kStart.size(), chunk(records).size(), "");
  const std::vector<Read> expected{{"/a", 5, "x"}, {"/a", 4, "y"}};
  const std::string channels = schema() + channel(1, "/a");
  for (const std::string& summary :
       {std::string(), schema(), channel(1, "/a"), channels, channels + statistics(2, 1, 1), channels + index,
        channels + statistics(2, 1, 1) + index, statistics(2, 1, 1) + index,
        channels + statistics(0, 1, 2) + index, channels + statistics(~std::uint64_t{0}, 1, 1) + index}) {
    const McapReader reader = reader_of(ended(data, summary));
    EXPECT_TRUE(reader.is_whole());
    EXPECT_EQ(messages_of(reader), expected);
  }
}

// Files without chunks are read, whole or cut; they have a checksum only in their end.
TEST_F(McapReading, HasMessagesOutsideOfChunks) {
  const std::string data = kStart + message(1, 5, "x") + message(1, 4, "");
  const std::vector<Read> expected{{"/a", 5, "x"}, {"/a", 4, ""}};
  for (const std::string& bytes :
       {ended(data), data, data + "\x05", data + message(1, 3, "z").substr(0, 30)}) {
    const McapReader reader = reader_of(bytes);
    EXPECT_EQ(messages_of(reader), expected);
    const McapReader::Entry& entry = reader.entries(1).front();
    EXPECT_EQ(entry.chunk, McapReader::kNoChunk);
    EXPECT_EQ(entry.offset, kStart.size());
  }
  std::string damaged = ended(data);
  damaged[damaged.find('x', kStart.size())] = 'y';
  expect_refusal(damaged, "data that do not fit their checksum");
}

// Records of other kinds are skipped; fields of later versions behind the known ones too.
TEST_F(McapReading, SkipsWhatItDoesNotKnow) {
  const std::string others = record(kAttachment, "any") + record(kMetadata, "") + record(kOfUsers, "any");
  const std::string extended = record(kSchema, schema(2, "B").substr(9) + "later");
  const McapReader reader =
      reader_of(ended(header() + others + schema() + extended + others + channel(1, "/a", 2) +
                      chunk(others + message(1, 1, "x") + record(kOfUsers, ""))));
  EXPECT_EQ(reader.channels().front().schema_name, "B");
  EXPECT_EQ(messages_of(reader), (std::vector<Read>{{"/a", 1, "x"}}));
}

// A channel may have no schema.
TEST_F(McapReading, HasChannelsWithoutASchema) {
  const McapReader reader = reader_of(ended(header() + channel(7, "/a", 0) + chunk(message(7, 1, "x"))));
  const McapReader::Channel* channel = reader.find("/a");
  ASSERT_NE(channel, nullptr);
  EXPECT_EQ(channel->id, 7U);
  EXPECT_EQ(channel->schema_name + channel->schema_encoding + channel->schema_text, "");
  EXPECT_EQ(messages_of(reader).size(), 1U);
}

// Entries are in the order of the file, in whatever order the index has them.
TEST_F(McapReading, HasAnIndexInTheOrderOfTimeInTheOrderOfTheFile) {
  const std::string first = message(1, 9, "x"), records = first + message(1, 3, "y");
  const std::string index = message_index(1, u64(3) + u64(first.size()) + u64(9) + u64(0));
  EXPECT_EQ(messages_of(reader_of(ended(kStart, chunk(records), index, 2))),
            (std::vector<Read>{{"/a", 9, "x"}, {"/a", 3, "y"}}));
}

// What a message index announces must be there.
TEST_F(McapReading, OfAWrongMessageIndexIsRefused) {
  const std::string one = message(1, 5, "x"), records = chunk(one + message(1, 5, "y"));
  const auto refuses = [&](const std::string& entries, const std::string& expected) {
    expect_refusal(ended(kStart, records, message_index(1, entries), entries.size() / 16), expected);
  };
  refuses(u64(5) + u64(2 * one.size()), "points outside its chunk");
  refuses(u64(5) + u64(~std::uint64_t{0}), "points outside its chunk");
  refuses(u64(5) + u64(2 * one.size() - 1), "no message, although the index announces one");
  refuses(u64(5) + u64(1), "no message, although the index announces one");
  refuses(u64(6) + u64(0), "of another channel or time");
  refuses(u64(5) + u64(0) + u64(5) + u64(0), "has a message twice");
  refuses(u64(5) + u64(0) + "1", "a list that ends within an element");
  const std::string huge = record(kMessageIndex, id(1) + u32(0xFFFFFFF0U) + u64(5) + u64(0));
  expect_refusal(ended(kStart, records, huge, 1), "a field that exceeds its record");
  expect_refusal(ended(kStart, records, message_index(2, u64(5) + u64(0)), 1), "of another channel");
}

// What a chunk index announces must be there too, once.
TEST_F(McapReading, OfAWrongChunkIndexIsRefused) {
  const std::string one = chunk(message(1, 5, "x")), index = message_index(1, u64(5) + u64(0));
  const std::uint64_t at = kStart.size(), huge = ~std::uint64_t{0};
  const std::string map = id(1) + u64(at + one.size());
  const auto refuses = [&](std::uint64_t messages, std::uint32_t chunks, const std::string& indices,
                           const std::string& expected) {
    const std::string start = schema() + channel(1, "/a") + statistics(messages, 1, chunks);
    expect_refusal(ended(kStart + one + index, start + indices), expected);
  };
  const std::string no_chunk = "an index of a chunk that is not there";
  for (const std::uint64_t wrong : {std::uint64_t{0}, at + 1, at + one.size(), huge, huge - 8})
    refuses(1, 1, chunk_index(wrong, one.size(), map), no_chunk);
  refuses(1, 1, chunk_index(at, one.size() - 1, map), no_chunk);
  const std::string right = chunk_index(at, one.size(), map);
  refuses(2, 2, right + right, no_chunk);
  refuses(2, 1, chunk_index(at, one.size(), map + map), "a second message index of the same channel");
  for (const std::uint64_t wrong : {std::uint64_t{0}, at, huge})
    refuses(1, 1, chunk_index(at, one.size(), id(1) + u64(wrong)), "a message index that is not there");
}

// A message belongs to a channel and a channel to a schema, which the file has before it.
TEST_F(McapReading, OfUndeclaredOrContradictoryChannelsIsRefused) {
  expect_refusal(ended(kStart + chunk(message(2, 0, "x"))), "a message of channel 2, which is not there");
  expect_refusal(ended(header() + message(1, 0, "x")), "a message of channel 1, which is not there");
  expect_refusal(ended(header() + channel(1, "/a")), "a channel of a schema that is not there");
  expect_refusal(ended(header() + schema(0)), "a schema with the number 0");
  expect_refusal(ended(kStart + channel(1, "/b")), "another channel with the number 1");
  expect_refusal(ended(kStart + schema(1, "B")), "another schema with the number 1");
  const McapReader reader = reader_of(kStart);
  EXPECT_THROW((void)reader.entries(2), std::logic_error);
  EXPECT_THROW((void)reader.read(1, {0, 0, 0}), std::logic_error);
}

// Lengths that exceed what they are in are refused, however large they are.
TEST_F(McapReading, OfLengthsBeyondTheFileIsRefused) {
  for (const std::uint64_t length : {std::uint64_t{1'000}, ~std::uint64_t{0}, ~std::uint64_t{0} - 8}) {
    const std::string beyond = number<std::uint8_t>(kMessage) + u64(length);
    expect_refusal(ended(kStart + beyond), "no complete record begins here");
    expect_refusal(ended(kStart + chunk(beyond)), "no complete record begins here");
    EXPECT_FALSE(reader_of(kStart + beyond).is_whole());
    const std::string times = u64(0) + u64(0);
    const std::string large = times + u64(length) + u32(0) + text("") + u64(length) + "few";
    expect_refusal(ended(kStart + record(kChunk, large)), "a field that exceeds its record");
    const std::string other = times + u64(length) + u32(0) + text("") + u64(3) + "few";
    expect_refusal(ended(kStart + record(kChunk, other)), "does not have the size that it announces");
  }
  expect_refusal(ended(kStart + record(kMessage, id(1))), "a field that exceeds its record");
  expect_refusal(ended(header() + record(kSchema, id(1) + u32(0xFFFFFFFFU))), "a field that exceeds");
  const std::string map = schema() + statistics(0, 0, 1) + record(kChunkIndex, "");
  expect_refusal(ended(kStart, map), "a field that exceeds its record");
}

// The footer and the summary are checked before they are believed.
TEST_F(McapReading, OfAWrongFooterIsRefused) {
  std::string summary = TwoChunks().bytes;
  summary[summary.rfind("/b")] = 'x';
  expect_refusal(summary, "a summary that does not fit its checksum");
  for (const std::uint64_t start : {std::uint64_t{7}, std::uint64_t{9'999}, ~std::uint64_t{0}}) {
    const std::string footer = record(kFooter, u64(start) + u64(0) + u32(0));
    expect_refusal(kStart + record(kDataEnd, u32(0)) + footer + kMagic,
                   "a footer that places the summary outside the file");
  }
}

// A checksum of 0 says that there is none.
TEST_F(McapReading, NeedsNoChecksums) {
  const std::string one = message(1, 5, "x");
  const std::string unchecked = u64(0) + u64(0) + u64(one.size()) + u32(0) + text("") + u64(one.size()) + one;
  const std::string footer = record(kFooter, u64(0) + u64(0) + u32(0));
  const McapReader reader =
      reader_of(kStart + record(kChunk, unchecked) + record(kDataEnd, u32(0)) + footer + kMagic);
  EXPECT_TRUE(reader.is_whole());
  EXPECT_EQ(messages_of(reader).size(), 1U);
}

// What is no recording at all is told in plain words.
TEST_F(McapReading, OfWhatIsNoRecordingNamesIt) {
  const auto refusal = [](const std::string& path) -> std::string {
    try {
      const McapReader reader(path);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal(folder_.path("none.mcap")),
            "recording '" + folder_.path("none.mcap") +
                "': cannot be read: No such file or directory; give an existing file");
  EXPECT_NE(refusal(folder_.path("")).find("is not a file"), std::string::npos);
  EXPECT_NE(refusal(folder_.put("empty", {})).find("is empty"), std::string::npos);
  EXPECT_NE(refusal(folder_.put("text", {'a', ',', 'b', '\n'}))
                .find("is not an MCAP file: it begins with 'a,b?'; give"),
            std::string::npos);
  EXPECT_NE(refusal("/dev/null").find("is not a file"), std::string::npos);
  expect_refusal(std::string("\x89MCAP1\r\n", 8), "is not an MCAP file: it begins with '?MCAP1");
  expect_refusal(kMagic + schema(), "a record before the header");
}

TEST(McapReader, RefusesWhatIsNoFileOrNoRecordingAtOnce) {
  expect_all_refused(".mcap", [](const std::string& path) { McapReader reader(path); });
}

}  // namespace
}  // namespace tumblesight::sim
