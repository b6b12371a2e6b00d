#include "sim/campaign/shards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::size_t kMostNamed = 8;  // in a message

struct OpenShard {
  std::string path;
  ShardContent content;
};

std::string joined_texts(const std::vector<std::string>& texts) {
  std::string all;
  for (std::size_t i = 0; i < texts.size() && i < kMostNamed; ++i) all += (i == 0 ? "" : ", ") + texts[i];
  if (texts.size() > kMostNamed) all += fmt::format(" and {} more", texts.size() - kMostNamed);
  return all;
}

void require_one_evaluation(const std::vector<OpenShard>& shards) {
  const OpenShard& first = shards.front();
  for (const OpenShard& shard : shards) {
    const std::string differs = difference(shard.content.header.identity, first.content.header.identity);
    if (differs.empty()) continue;
    throw std::runtime_error(fmt::format(
        "shard file '{}' is of another evaluation than '{}': {}; merge the shards of one evaluation only",
        shard.path, first.path, differs));
  }
}

// Every file has all sequences of its shard.
void require_complete(const std::vector<OpenShard>& shards, const std::vector<ExperimentRun>& runs) {
  for (const OpenShard& shard : shards) {
    std::size_t wanted = 0;
    std::size_t done = 0;
    for (std::size_t run = 0; run < runs.size(); ++run) {
      wanted += sequences_of(shard.content.header.shard, runs[run].sequences).size();
      done += shard.content.done[run].size();
    }
    if (done == wanted) continue;
    throw std::runtime_error(
        fmt::format("shard file '{}' has {} of its {}; run its command again, it goes on where it stopped:\n"
                    "  {} --shard {} --shard-file {}",
                    shard.path, done, counted(wanted, "sequence"), shard.content.header.command,
                    to_string(shard.content.header.shard), shell_word(shard.path)));
  }
}

void require_no_doubles(const std::vector<OpenShard>& shards, std::size_t runs) {
  for (std::size_t run = 0; run < runs; ++run) {
    std::map<std::uint32_t, const OpenShard*> owners;
    for (const OpenShard& shard : shards) {
      for (const std::uint32_t sequence : shard.content.done[run]) {
        const auto [place, is_new] = owners.emplace(sequence, &shard);
        if (is_new) continue;
        const OpenShard& other = *place->second;
        throw std::runtime_error(
            fmt::format("shard files '{}' ({}) and '{}' ({}) both have sequence {}; leave one of them out",
                        other.path, to_string(other.content.header.shard), shard.path,
                        to_string(shard.content.header.shard), sequence));
      }
    }
  }
}

// As parts, if all files are parts of as many; otherwise as sequences.
std::string missing_text(const std::vector<OpenShard>& shards, std::uint32_t sequences) {
  std::vector<bool> there(sequences);
  std::set<std::uint32_t> counts;
  for (const OpenShard& shard : shards) {
    counts.insert(shard.content.header.shard.count);
    for (const std::uint32_t sequence : shard.content.done[0]) there[sequence] = true;
  }
  const bool as_parts = counts.size() == 1;
  const std::uint32_t count = as_parts ? *counts.begin() : sequences;
  std::set<std::uint32_t> missing;
  for (std::uint32_t i = 0; i < sequences; ++i)
    if (!there[i]) missing.insert(i % count);
  std::vector<std::string> names;
  for (const std::uint32_t index : missing)
    names.push_back(as_parts ? to_string(Shard{index, count}) : fmt::format("sequence {}", index));
  return joined_texts(names);
}

void require_all(const std::vector<OpenShard>& shards, const std::vector<ExperimentRun>& runs) {
  for (std::size_t run = 0; run < runs.size(); ++run) {
    std::size_t there = 0;
    for (const OpenShard& shard : shards) there += shard.content.done[run].size();
    if (there == runs[run].sequences) continue;
    throw std::runtime_error(fmt::format(
        "the shards have {} of {} of the evaluation; missing: {}. They are made by\n  {} --shard I/N "
        "--shard-file FILE",
        there, counted(runs[run].sequences, "sequence"), missing_text(shards, runs[0].sequences),
        shards.front().content.header.command));
  }
}

void note_missing(const std::vector<OpenShard>& shards, const std::vector<ExperimentRun>& runs,
                  std::vector<std::string>& notes) {
  std::size_t there = 0;
  std::size_t all = 0;
  for (const ExperimentRun& run : runs) all += run.sequences;
  for (const OpenShard& shard : shards)
    for (const auto& done : shard.content.done) there += done.size();
  if (there == all) return;
  notes.push_back(fmt::format("These are figures of {} sequences; {} of the evaluation are not done.", there,
                              all - there));
}

void note_damaged(const std::vector<OpenShard>& shards, std::vector<std::string>& notes) {
  for (const OpenShard& shard : shards)
    if (shard.content.is_damaged)
      notes.push_back(
          fmt::format("A record of shard file {} is damaged. The {} from there on are left out; its command "
                      "runs again what they held.",
                      shard.path, counted(shard.content.dropped_bytes, "byte")));
}

void require_a_sequence(const std::vector<OpenShard>& shards) {
  for (const OpenShard& shard : shards)
    for (const auto& done : shard.content.done)
      if (!done.empty()) return;
  throw NothingDone(fmt::format(
      "no sequence is done in {}; run the command of the shards first:\n  {} --shard I/N --shard-file FILE",
      shards.size() == 1 ? "shard file '" + shards.front().path + "'" : "any of the shard files",
      shards.front().content.header.command));
}

std::vector<OpenShard> open_shards(const std::vector<std::string>& paths) {
  std::vector<OpenShard> shards;
  for (const std::string& path : paths) shards.push_back({path, read_shard(path)});
  return shards;
}

}  // namespace

void note_builds(const std::set<std::string>& commits, std::vector<std::string>& notes) {
  if (commits.size() < 2) return;
  notes.push_back(fmt::format("The shards were made by different builds of the program: commits {}.",
                              joined_texts({commits.begin(), commits.end()})));
}

std::uint64_t steps_of(const ExperimentSettings& settings, const Shard& shard) {
  std::uint64_t steps = 0;
  for (const ExperimentRun& run : runs_of(settings))
    steps += steps_of(run, static_cast<std::uint32_t>(sequences_of(shard, run.sequences).size()));
  return steps;
}

void run_shard(const Subject& subject, const ExperimentSettings& settings, const Shard& shard,
               ShardWriter& file, const std::function<void(std::uint64_t)>& progress) {
  std::uint64_t done_before = 0;
  const std::vector<ExperimentRun> runs = runs_of(settings);
  for (std::size_t run = 0; run < runs.size(); ++run)
    done_before += steps_of(runs[run], static_cast<std::uint32_t>(file.done()[run].size()));
  const auto rest = [&](std::size_t run, const ExperimentRun& of) {
    std::vector<std::uint32_t> indices = sequences_of(shard, of.sequences);
    const std::set<std::uint32_t>& done = file.done()[run];
    indices.erase(
        std::remove_if(indices.begin(), indices.end(), [&](std::uint32_t i) { return done.count(i) != 0; }),
        indices.end());
    return indices;
  };
  run_chosen(
      subject, settings, rest, [&](std::size_t run, SequenceResult&& result) { file.append(run, result); },
      [&](std::uint64_t steps) { progress(done_before + steps); });
  file.finish();
}

MergedShards merge_shards(const std::vector<std::string>& paths, MergeMode mode) {
  if (paths.empty()) throw NothingDone("there are no shard files to merge");
  const std::vector<OpenShard> shards = open_shards(paths);
  require_one_evaluation(shards);
  const ExperimentIdentity& identity = shards.front().content.header.identity;
  const std::vector<ExperimentRun> runs = runs_of(identity.settings);
  require_no_doubles(shards, runs.size());
  if (mode == MergeMode::kComplete) {
    require_complete(shards, runs);
    require_all(shards, runs);
  }
  require_a_sequence(shards);
  ExperimentFigures figures(identity.subject, identity.settings);
  for (std::size_t run = 0; run < runs.size(); ++run) {
    for (const OpenShard& shard : shards)
      read_run(shard.path, shard.content, run,
               [&](SequenceResult&& result) { figures.add(run, std::move(result)); });
  }
  MergedShards merged{identity, shards.front().content.header.command, {}, {}, figures.finish()};
  set_replay(merged.figures, merged.command);
  for (const OpenShard& shard : shards) merged.commits.insert(shard.content.header.commit);
  note_missing(shards, runs, merged.notes);
  note_damaged(shards, merged.notes);
  return merged;
}

}  // namespace tumblesight::sim
