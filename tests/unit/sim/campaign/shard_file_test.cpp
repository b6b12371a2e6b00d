#include "sim/campaign/shard_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "gnc/numerics/crc.hpp"
#include "sim/campaign/sequence_record.hpp"
#include "tests/support/hostile_files.hpp"
#include "tests/unit/sim/campaign/campaign_test_support.hpp"

namespace tumblesight::sim {
namespace {

TEST(Shard, IsReadFromItsText) {
  EXPECT_EQ(to_string(shard_from("0/1")), "0/1");
  EXPECT_EQ(to_string(shard_from("15/16")), "15/16");
  for (const char* text : {"", "/", "1", "1/", "/2", "2/2", "-1/2", "1/2/3", "0/0", "a/2", "1/ 2", "0/100001",
                           "0/99999999999", "1.0/2"}) {
    const std::string error = error_of([&] { (void)shard_from(text); });
    EXPECT_NE(error.find("N is a whole number from 1 to 100000, I from 0 to N - 1"), std::string::npos)
        << text;
  }
}

TEST(Shard, AllPartsTogetherHaveEverySequenceOnce) {
  for (std::uint32_t count = 1; count <= 20; ++count) {
    std::vector<int> seen(17);
    for (std::uint32_t index = 0; index < count; ++index)
      for (const std::uint32_t sequence : sequences_of({index, count}, 17)) ++seen[sequence];
    EXPECT_EQ(seen, std::vector<int>(17, 1)) << count;
  }
}

class ShardFile : public ::testing::Test {
 protected:
  static std::string read_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  SmallEvaluation small_;
  TemporaryFolder folder_;
};

TEST_F(ShardFile, BelongsToOneWriterAtATime) {
  const std::string path = folder_.path("a");
  EXPECT_FALSE(is_in_use(path));
  {
    const ShardWriter first(path, small_.header({0, 2}));
    EXPECT_TRUE(is_in_use(path));
    EXPECT_THROW(ShardWriter(path, small_.header({0, 2})), ShardInUse);
  }
  EXPECT_FALSE(is_in_use(path));
  EXPECT_NO_THROW(ShardWriter(path, small_.header({0, 2})));
}

TEST_F(ShardFile, OfAnotherShardOrEvaluationIsNotContinued) {
  const std::string path = folder_.path("a");
  { const ShardWriter first(path, small_.header({0, 2})); }
  const std::string of_shard = error_of([&] { ShardWriter(path, small_.header({1, 2})); });
  EXPECT_NE(
      of_shard.find("it is of another run: shard is 0/2, not 1/2; name another file, or delete this one"),
      std::string::npos)
      << of_shard;
  small_.settings.seed = 1;
  const std::string of_seed = error_of([&] { ShardWriter(path, small_.header({0, 2})); });
  EXPECT_NE(of_seed.find("seed is 12345678901234567890, not 1"), std::string::npos) << of_seed;
}

TEST_F(ShardFile, AnyOtherFileIsRefusedAndLeftAsItIs) {
  const std::string path = folder_.put("notes.txt", {'h', 'e', 'l', 'l', 'o'});
  EXPECT_NE(error_of([&] { (void)read_shard(path); }).find("it is no shard file"), std::string::npos);
  EXPECT_NE(error_of([&] {
              ShardWriter(path, small_.header({0, 2}));
            }).find("it is no shard file"),
            std::string::npos);
  EXPECT_EQ(std::filesystem::file_size(path), 5U);
  EXPECT_NE(error_of([&] { (void)read_shard(folder_.path("none")); }).find("No such file"),
            std::string::npos);
  EXPECT_NE(error_of([&] { (void)read_shard(folder_.path("")); }).find("cannot be read"), std::string::npos);
}

TEST_F(ShardFile, AFileThatCannotBeWrittenIsNamed) {
  const std::string error = error_of([&] { ShardWriter(folder_.path(""), small_.header({0, 2})); });
  EXPECT_NE(error.find("it is no plain file"), std::string::npos) << error;
}

TEST_F(ShardFile, OneThatIsBeingWrittenIsNotCut) {
  const std::string path = folder_.path("s");
  const ShardWriter writer(path, small_.header({0, 2}));
  EXPECT_THROW((void)cut_to_whole_records(path), ShardInUse);
}

TEST_F(ShardFile, MissingFoldersAreMade) {
  EXPECT_NO_THROW(ShardWriter(folder_.path("a/b/c"), small_.header({0, 2})));
}

TEST_F(ShardFile, OfAnotherBuildIsNotContinued) {
  const std::string path = folder_.path("a");
  { const ShardWriter first(path, small_.header({0, 2})); }
  ShardHeader header = small_.header({0, 2});
  header.commit = "def";
  const std::string error = error_of([&] { ShardWriter(path, header); });
  EXPECT_NE(error.find("it was begun by the build of commit abc, not def"), std::string::npos) << error;
}

TEST_F(ShardFile, KilledAtAnyByteOfItsHeaderIsBegunAnew) {
  const std::string path = folder_.path("a");
  { const ShardWriter whole(path, small_.header({0, 2})); }
  const std::string bytes = read_text(path);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    std::ofstream(path, std::ios::binary) << bytes.substr(0, size);
    EXPECT_FALSE(header_of(path)) << size;
    EXPECT_EQ(records_in(path), 0U);
    { const ShardWriter again(path, small_.header({0, 2})); }
    ASSERT_EQ(read_text(path), bytes) << size;
  }
  EXPECT_TRUE(header_of(path));
}

TEST_F(ShardFile, WithRecordsThatAreNotItsOwnOrTwiceIsRefused) {
  const std::string path = small_.run({0, 4}, folder_), other = small_.run({1, 4}, folder_);
  const std::string bytes = read_text(path);
  const std::size_t record_bytes = record_size_bytes(small_.settings.frames);
  const auto last_of = [&](const std::string& file) {
    const std::string all = read_text(file);
    return all.substr(all.size() - record_bytes);
  };
  std::ofstream(path, std::ios::binary) << bytes << last_of(path);
  EXPECT_NE(error_of([&] { (void)read_shard(path); }).find("it holds sequence 12 twice"), std::string::npos);
  std::ofstream(path, std::ios::binary) << bytes << last_of(other);
  EXPECT_NE(error_of([&] { (void)read_shard(path); }).find("it holds sequence 9, which is not of shard 0/4"),
            std::string::npos);
}

TEST_F(ShardFile, IsCutToItsWholeRecords) {
  const std::string path = small_.run({0, 4}, folder_);
  EXPECT_EQ(cut_to_whole_records(path), 0U);
  const std::size_t record_bytes = record_size_bytes(small_.settings.frames);
  std::string bytes = read_text(path);
  bytes[bytes.size() - record_bytes - 1] ^= 1;  // of the last but one
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_EQ(records_in(path), 4U) << "by its size";
  EXPECT_EQ(cut_to_whole_records(path), 2 * record_bytes);
  EXPECT_EQ(records_in(path), 2U);
}

TEST_F(ShardFile, ItsSizeTellsTheNumberOfItsRecords) {
  const std::string path = small_.run({0, 4}, folder_);
  EXPECT_EQ(records_in(path), 4U);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
  EXPECT_EQ(records_in(path), 3U);
  EXPECT_EQ(records_in(folder_.path("none")), 0U);
  EXPECT_EQ(records_in(folder_.put("other", {1, 2, 3})), 0U);
}

TEST_F(ShardFile, IsRefusedIfItIsNoFileOrNoShard) {
  expect_all_refused(".shard", [](const std::string& path) { (void)read_shard(path); });
  // An empty file is one that was begun.
  const HostileFiles hostile(".shard");
  for (const HostileFile& file : hostile.files()) {
    const Outcome header = outcome_of([&] { (void)header_of(file.path); });
    const Outcome writer = outcome_of([&] { const ShardWriter begun(file.path, small_.header({0, 2})); });
    for (const Outcome& outcome : {header, writer}) {
      EXPECT_EQ(outcome.signal, 0) << file.kind;
      EXPECT_EQ(outcome.message.empty(), file.kind == "empty") << file.kind << outcome.message;
    }
  }
}

TEST_F(ShardFile, WhoseHeaderIsNestedDeeplyIsRefused) {
  const std::string json = R"({"shard": "0/1", "command": )" + std::string(30'000, '[');
  const std::uint32_t crc = gnc::crc32(reinterpret_cast<const std::uint8_t*>(json.data()), json.size());
  std::string bytes = "tumblesight shard 1\n" + json + "\n";
  bytes.append(reinterpret_cast<const char*>(&crc), sizeof crc);
  const std::string path = folder_.put("deep", {bytes.begin(), bytes.end()});
  EXPECT_NE(error_of([&] { (void)read_shard(path); }).find("nested more than 32 deep"), std::string::npos);
}

}  // namespace
}  // namespace tumblesight::sim
