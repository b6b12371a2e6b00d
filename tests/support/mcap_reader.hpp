// McapReader: reads the files of McapWriter by the words of mcap.dev/spec, and shares no code with it. Every
// length, checksum and index is checked by expectations of GoogleTest.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "gnc/numerics/crc.hpp"

namespace tumblesight {

class McapReader {
 public:
  struct Message {
    std::string topic;
    std::uint32_t sequence;
    std::uint64_t time_ns;
    std::string data;
  };

  // `is_whole`: false for a file whose end is missing.
  explicit McapReader(const std::string& bytes, bool is_whole = true) : bytes_(bytes) {
    EXPECT_EQ(bytes.substr(0, 8), std::string("\x89MCAP0\r\n", 8));
    std::size_t at = 8, summary = 0;
    while (at + 9 <= bytes.size()) {
      const auto opcode = static_cast<std::uint8_t>(bytes[at]);
      const std::size_t length = number(at + 1, 8), content = at + 9;
      if (content + length > bytes.size()) break;
      if (opcode == 2) footer(at, content, summary);
      if (opcode == 2) break;
      if (opcode == 15) {
        EXPECT_EQ(number(content, 4), crc(0, at));
        summary = content + length;
      }
      if (summary == 0 && opcode == 3) schemas[number(content, 2)] = text(content + 2);
      if (summary == 0 && opcode == 4) topics_[number(content, 2)] = text(content + 4);
      if (opcode == 6) chunk(at, content);
      if (opcode == 7) message_index(content);
      if (opcode == 8) chunk_index(content);
      if (opcode == 11) messages_in_statistics = number(content, 8);
      at = content + length;
    }
    if (!is_whole) return;
    EXPECT_EQ(indexed_chunks_, chunks_.size());
    EXPECT_EQ(bytes.substr(bytes.size() - 8), bytes.substr(0, 8));
  }
  std::size_t count(const std::string& topic) const {
    std::size_t sum = 0;
    for (const Message& message : messages) sum += message.topic == topic ? 1U : 0U;
    return sum;
  }
  const Message* first(const std::string& topic) const {
    for (const Message& message : messages)
      if (message.topic == topic) return &message;
    return nullptr;
  }

  std::vector<Message> messages;
  std::map<std::uint64_t, std::string> schemas;  // names
  std::uint64_t messages_in_statistics = 0;
  std::size_t chunks() const { return chunks_.size(); }

 private:
  std::uint64_t number(std::size_t at, int size) const {
    std::uint64_t value = 0;
    for (int i = size; i-- > 0;)
      value = (value << 8) | static_cast<std::uint8_t>(bytes_.at(at + static_cast<std::size_t>(i)));
    return value;
  }
  std::string text(std::size_t at) const { return bytes_.substr(at + 4, number(at, 4)); }
  std::uint64_t crc(std::size_t from, std::size_t to) const {
    return gnc::crc32(reinterpret_cast<const std::uint8_t*>(bytes_.data()) + from, to - from);
  }
  void footer(std::size_t at, std::size_t content, std::size_t summary) {
    EXPECT_EQ(number(content, 8), summary);
    EXPECT_EQ(number(content + 16, 4), crc(summary, at + 9 + 16));
    // Every group that is announced begins with a record of its kind.
    for (std::size_t offset = number(content + 8, 8); offset < at; offset += 9 + 17) {
      EXPECT_EQ(number(offset, 1), 14U);
      EXPECT_EQ(number(number(offset + 10, 8), 1), number(offset + 9, 1));
    }
  }
  void chunk(std::size_t at, std::size_t content) {
    chunks_.push_back(at);
    const std::size_t size = number(content + 16, 8), records = content + 8 + 8 + 8 + 4 + 4 + 8;
    EXPECT_EQ(number(content + 24, 4), crc(records, records + size));
    records_ = records;
    for (std::size_t one = records; one < records + size;) {
      EXPECT_EQ(number(one, 1), 5U);
      const std::size_t length = number(one + 1, 8), from = one + 9;
      messages.push_back({topics_.at(number(from, 2)), static_cast<std::uint32_t>(number(from + 2, 4)),
                          number(from + 6, 8), bytes_.substr(from + 22, length - 22)});
      EXPECT_GE(number(from + 6, 8), number(content, 8));
      EXPECT_LE(number(from + 6, 8), number(content + 8, 8));
      one = from + length;
    }
  }
  // Of the chunk before it.
  void message_index(std::size_t content) {
    const std::uint64_t channel = number(content, 2), size = number(content + 2, 4);
    for (std::size_t entry = content + 6; entry < content + 6 + size; entry += 16) {
      const std::size_t record = records_ + number(entry + 8, 8);
      EXPECT_EQ(number(record + 9, 2), channel);
      EXPECT_EQ(number(record + 15, 8), number(entry, 8));
    }
  }
  void chunk_index(std::size_t content) {
    ASSERT_LT(indexed_chunks_, chunks_.size());
    EXPECT_EQ(number(content + 16, 8), chunks_[indexed_chunks_++]);
    const std::size_t offsets = number(content + 32, 4);
    for (std::size_t entry = content + 36; entry < content + 36 + offsets; entry += 10) {
      const std::size_t index = number(entry + 2, 8);
      EXPECT_EQ(number(index, 1), 7U);
      EXPECT_EQ(number(index + 9, 2), number(entry, 2));
    }
  }

  const std::string& bytes_;
  std::map<std::uint64_t, std::string> topics_;
  std::vector<std::size_t> chunks_;
  std::size_t records_ = 0;  // of the last chunk
  std::size_t indexed_chunks_ = 0;
};

}  // namespace tumblesight
