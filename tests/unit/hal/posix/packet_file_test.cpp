// Verifies TS-TLM-090.
#include "hal/posix/packet_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace tumblesight::hal::posix {
namespace {

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(PacketFile, HoldsThePacketsOneAfterTheOther) {
  const std::string path = ::testing::TempDir() + "packets_" + std::to_string(getpid());
  packets::TelemetryEncoder encoder;
  PacketFile file;
  ASSERT_EQ(file.open(path.c_str()), 0);
  EXPECT_TRUE(file.put(encoder.encode(MemoryDump{})));  // replaced below
  ASSERT_EQ(file.open(path.c_str()), 0);
  std::string expected;
  for (int i = 0; i < 3; ++i) {
    const packets::TelemetryPacket& packet = encoder.encode(Event{});
    EXPECT_TRUE(file.put(packet));
    expected.append(reinterpret_cast<const char*>(packet.bytes.data()), packet.size);
  }
  EXPECT_EQ(content_of(path), expected);
  EXPECT_EQ(file.lost(), 0U);
  std::filesystem::remove(path);
}

TEST(PacketFile, KeepsAFileWithAnythingElse) {
  const std::string path = ::testing::TempDir() + "notes_" + std::to_string(getpid());
  for (const std::string& content : {std::string("x"), std::string("something from before")}) {
    std::ofstream(path, std::ios::trunc) << content;
    PacketFile file;
    EXPECT_EQ(file.open(path.c_str()), EEXIST);
    EXPECT_EQ(content_of(path), content);
  }
  std::ofstream(path, std::ios::trunc).close();
  PacketFile file;
  EXPECT_EQ(file.open(path.c_str()), 0) << "an empty file";
  std::filesystem::remove(path);
}

TEST(PacketFile, ReportsAFileThatCannotBeCreated) {
  PacketFile file;
  EXPECT_EQ(file.open("/no/such/folder/packets"), ENOENT);
}

// Opening one for writing waits for a reader.
TEST(PacketFile, APipeThatNobodyReadsIsRefusedAtOnce) {
  const std::string path = ::testing::TempDir() + "pipe_" + std::to_string(getpid());
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  PacketFile file;
  EXPECT_EQ(file.open(path.c_str()), ENXIO);
  const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(reader, 0);
  EXPECT_EQ(file.open(path.c_str()), 0);
  packets::TelemetryEncoder encoder;
  EXPECT_TRUE(file.put(encoder.encode(Event{})));
  close(reader);
  std::filesystem::remove(path);
}

TEST(PacketFile, CountsLostPacketsAndNamesTheReason) {
  packets::TelemetryEncoder encoder;
  PacketFile file;
  EXPECT_FALSE(file.put(encoder.encode(Event{})));  // not open
  EXPECT_EQ(file.error(), EBADF);
  ASSERT_EQ(file.open("/dev/full"), 0);
  EXPECT_FALSE(file.put(encoder.encode(Event{})));
  EXPECT_EQ(file.lost(), 2U);
  EXPECT_EQ(file.error(), ENOSPC);
}

}  // namespace
}  // namespace tumblesight::hal::posix
