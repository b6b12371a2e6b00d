// Shards give the figures of one process, bit for bit, and what does not belong together is refused by name.
#include "sim/campaign/shards.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/unit/sim/campaign/campaign_test_support.hpp"

namespace tumblesight::sim {
namespace {

class Shards : public ::testing::Test {
 protected:
  std::vector<std::string> run_all(std::uint32_t count) const {
    std::vector<std::string> paths;
    for (std::uint32_t index = 0; index < count; ++index)
      paths.push_back(small_.run({index, count}, folder_));
    return paths;
  }
  void expect_refused(const std::vector<std::string>& paths, const std::vector<std::string>& parts) const {
    const std::string error = error_of([&] { (void)merge_shards(paths); });
    for (const std::string& part : parts) EXPECT_NE(error.find(part), std::string::npos) << error;
  }

  SmallEvaluation small_;
  TemporaryFolder folder_;
};

// Verifies TS-SIL-460.
TEST_F(Shards, GiveTheFiguresOfOneProcessWhateverTheirNumberAndOrder) {
  small_.settings.conditions = {Condition::kDegraded, Condition::kTumbling};
  const std::string expected = small_.figures_of_one_process();
  for (std::uint32_t count = 1; count <= 13; ++count) {
    std::vector<std::string> paths = run_all(count);
    EXPECT_EQ(small_.merged(paths), expected) << count;
    std::reverse(paths.begin(), paths.end());
    EXPECT_EQ(small_.merged(paths), expected) << count;
  }
}

// Verifies TS-SIL-460.
TEST_F(Shards, OfDifferentNumbersOfPartsGoTogether) {
  const std::string even = small_.run({0, 2}, folder_);
  const std::string first_odd = small_.run({1, 4}, folder_);
  const std::string second_odd = small_.run({3, 4}, folder_);
  EXPECT_EQ(small_.merged({second_odd, even, first_odd}), small_.figures_of_one_process());
}

// Lost frames, an effect, a symmetry and another sensor are figures as well.
// Verifies TS-SIL-460.
TEST_F(Shards, KeepEverythingThatMakesTheFigures) {
  small_.settings.disturbances.lost_frames = 1;
  small_.settings.effects = effects_from({"noise=0.1", "false_returns=0.003"});
  small_.subject.symmetry = target_symmetry_from({"z:4", "0.6,0.8,0:2"});
  small_.subject.sensor = sensor_named("flash_256");
  small_.subject.ranges = {33.3, 66.6, 12.3};
  EXPECT_EQ(small_.merged(run_all(3)), small_.figures_of_one_process());
}

// Verifies TS-SIL-460.
TEST_F(Shards, TakeTheCurvesWithThem) {
  small_.settings.curves = true;
  small_.settings.frames = 2;
  small_.settings.sequences = 4;
  EXPECT_EQ(small_.merged(run_all(2)), small_.figures_of_one_process());
}

// Wherever a shard is cut off, what is left of it is continued to the same bytes.
// Verifies TS-SIL-460.
TEST_F(Shards, AKilledOneGoesOnToTheSameBytes) {
  const std::string path = small_.run({1, 4}, folder_);
  const auto content = [&] {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string whole = content();
  const std::size_t header = whole.size() - 3 * ((whole.size() - whole.find('\n', 30)) / 3);
  for (const std::size_t kept : {header + 10, whole.size() / 2, whole.size() - 1, whole.size()}) {
    std::filesystem::resize_file(path, kept);
    small_.run({1, 4}, folder_);
    // Times differ: what was cut off was run again.
    EXPECT_EQ(content().size(), whole.size()) << kept;
    EXPECT_EQ(small_.merged({path, small_.run({0, 2}, folder_), small_.run({3, 4}, folder_)}),
              small_.figures_of_one_process())
        << kept;
  }
}

// A damaged record and all after it are run again.
TEST_F(Shards, EveryDamagedByteIsFoundAndMended) {
  const std::string path = small_.run({0, 13}, folder_);
  const auto size = std::filesystem::file_size(path);
  for (std::uintmax_t at = 0; at < size; at += 7) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(static_cast<std::streamoff>(at));
    const int byte = file.get();
    file.seekp(static_cast<std::streamoff>(at));
    file.put(static_cast<char>(byte ^ 0x10));
    file.close();
    const std::string error = error_of([&] {
      const ShardContent content = read_shard(path);
      if (content.done[0].empty()) throw std::runtime_error("a record less");
    });
    EXPECT_NE(error, "no error") << "byte " << at;
    std::fstream again(path, std::ios::in | std::ios::out | std::ios::binary);
    again.seekp(static_cast<std::streamoff>(at));
    again.put(static_cast<char>(byte));
  }
}

TEST_F(Shards, AMissingOneIsNamedWithTheCommand) {
  std::vector<std::string> paths = run_all(5);
  paths.erase(paths.begin() + 3);
  expect_refused(paths, {"the shards have 11 of 13 sequences", "missing: 3/5",
                         "tumblesight evaluate --sequences 13 --shard I/N --shard-file FILE"});
}

TEST_F(Shards, ADoubledOneIsNamed) {
  std::vector<std::string> paths = run_all(2);
  paths.push_back(small_.run({1, 2}, folder_, "copy"));
  expect_refused(paths, {"s1_2' (1/2)", "copy' (1/2)", "both have sequence 1", "leave one of them out"});
}

TEST_F(Shards, AnUnfinishedOneIsNamedWithItsCommand) {
  std::vector<std::string> paths = run_all(2);
  std::filesystem::resize_file(paths[1], std::filesystem::file_size(paths[1]) - 1);
  expect_refused(paths, {"s1_2' has 5 of its 6 sequences", "--shard 1/2 --shard-file " + paths[1]});
  const MergedShards partial = merge_shards(paths, MergeMode::kPartial);
  EXPECT_EQ(partial.figures.cells.at(0).sequences, 12U);
  EXPECT_EQ(partial.figures.cells.at(0).rcnn.count, 12U);
  ASSERT_EQ(partial.notes.size(), 1U);
  EXPECT_EQ(partial.notes[0], "These are figures of 12 sequences; 1 of the evaluation are not done.")
      << "a record that is being written is no damage";
}

TEST_F(Shards, ADamagedOneIsNoted) {
  const std::vector<std::string> paths = run_all(2);
  {
    std::fstream file(paths[0], std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(-1, std::ios::end);
    file.put('\x5a');
  }
  expect_refused(paths, {"s0_2' has 6 of its 7 sequences"});
  const MergedShards partial = merge_shards(paths, MergeMode::kPartial);
  ASSERT_EQ(partial.notes.size(), 2U);
  EXPECT_EQ(partial.notes[1].rfind("A record of shard file " + paths[0] + " is damaged. The ", 0), 0U)
      << partial.notes[1];
}

TEST_F(Shards, EachKindOfForeignOneIsNamedWithWhatDiffers) {
  const std::string first = small_.run({0, 2}, folder_);
  const auto expect_foreign = [&](const char* what, const std::function<void(SmallEvaluation&)>& change) {
    SmallEvaluation other;
    change(other);
    const std::string path = folder_.path("foreign");
    std::filesystem::remove(path);
    ShardHeader header = other.header({1, 2});
    if (std::string(what) == "version") header.identity.version = "1.2.4";
    { ShardWriter file(path, header); }
    expect_refused({first, path}, {"foreign' is of another evaluation", "s0_2'", what});
  };
  expect_foreign("version", [](SmallEvaluation&) {});
  expect_foreign("seed is 2, not 12345678901234567890", [](auto& other) { other.settings.seed = 2; });
  expect_foreign("model_crc32 is \"00000001\", not \"00c0ffee\"",
                 [](auto& other) { other.subject.model_crc32 = 1; });
  expect_foreign("mesh_crc32", [](auto& other) { other.subject.mesh.vertices_trf_m[0].x() += 1e-3F; });
  expect_foreign("sensor", [](auto& other) { other.subject.sensor.settings.rays = 64; });
  expect_foreign("ranges", [](auto& other) { other.subject.ranges.farthest_m = 99.0; });
  expect_foreign("swath_m", [](auto& other) { other.subject.swath_m += 1e-9; });
  expect_foreign("symmetry", [](auto& other) { other.subject.symmetry = target_symmetry_from({"z:2"}); });
  expect_foreign("inertia_kg_m2", [](auto& other) { other.subject.inertia_kg_m2.reset(); });
  expect_foreign("conditions", [](auto& other) { other.settings.conditions = {Condition::kDegraded}; });
  expect_foreign("sequences is 14, not 13", [](auto& other) { other.settings.sequences = 14; });
  expect_foreign("frames is 2, not 3", [](auto& other) { other.settings.frames = 2; });
  expect_foreign("effects", [](auto& other) { other.settings.effects = effects_from({"noise=2"}); });
  expect_foreign("disturbances", [](auto& other) { other.settings.disturbances.period_s = 2.5; });
  expect_foreign("baseline_sequences", [](auto& other) { other.settings.baseline_sequences = 1; });
  expect_foreign("curves", [](auto& other) { other.settings.curves = true; });
}

TEST_F(Shards, OfDifferentBuildsAreNoted) {
  std::vector<std::string> paths{small_.run({0, 2}, folder_)};
  ShardHeader header = small_.header({1, 2});
  header.commit = "def";
  paths.push_back(folder_.path("other_build"));
  {
    ShardWriter file(paths[1], header);
    run_shard(small_.subject, small_.settings, {1, 2}, file, [](std::uint64_t) {});
  }
  std::vector<std::string> notes;
  note_builds({"abc"}, notes);
  EXPECT_TRUE(notes.empty());
  note_builds(merge_shards(paths).commits, notes);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("different builds"), std::string::npos);
  EXPECT_NE(notes[0].find("abc, def"), std::string::npos);
}

// Parts of different counts overlap, so that missing sequences have no names as parts.
TEST_F(Shards, OfMixedCountsNameWhatIsMissingBySequence) {
  const std::vector<std::string> paths{small_.run({0, 2}, folder_), small_.run({1, 6}, folder_)};
  expect_refused(paths, {"9 of 13 sequences", "missing: sequence 3, sequence 5, sequence 9, sequence 11."});
}

TEST_F(Shards, NothingToMergeIsRefused) {
  expect_refused({}, {"there are no shard files"});
}

TEST_F(Shards, CountTheStepsOfAShard) {
  std::uint64_t last = 0;
  ShardWriter file(folder_.path("steps"), small_.header({1, 4}));
  run_shard(small_.subject, small_.settings, {1, 4}, file, [&](std::uint64_t done) { last = done; });
  EXPECT_EQ(last, 9U);
  EXPECT_EQ(steps_of(small_.settings, {1, 4}), 9U);
}

}  // namespace
}  // namespace tumblesight::sim
