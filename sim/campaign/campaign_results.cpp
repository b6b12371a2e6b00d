#include "sim/campaign/campaign_results.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

std::vector<std::string> paths_of(const std::vector<CampaignTask>& tasks, std::size_t run, MergeMode mode) {
  std::vector<std::string> paths;
  for (const CampaignTask& task : tasks) {
    if (task.run != run) continue;
    if (mode == MergeMode::kComplete || sequences_done(task) > 0) paths.push_back(task.path);
  }
  return paths;
}

struct Entry {
  SubjectResult subject;
  ExperimentIdentity identity;  // of its first run
  const CampaignRun* run;       // the first one
};

// What of a subject the names of its runs do not tell: whether it differs, and how the title tells it.
struct Distinction {
  bool (*differs)(const ExperimentIdentity& a, const ExperimentIdentity& b);
  void (*tell)(Entry& entry);
};

void add_variant(Entry& entry, const std::string& text) {
  std::string& variant = entry.subject.variant;
  variant += (variant.empty() ? "" : ", ") + text;
}

std::string option_of(const CampaignRun& run, const std::string& name) {
  const auto option = std::find(run.options.begin(), run.options.end(), name);
  return option == run.options.end() || option + 1 == run.options.end() ? std::string() : *(option + 1);
}

void tell_mesh_crc32(Entry& entry) {
  add_variant(entry, fmt::format("mesh with CRC-32 {:08x}", entry.identity.mesh_crc32));
}

// As the campaign file names it. A mission names its mesh itself.
void tell_mesh(Entry& entry) {
  const std::string path = option_of(*entry.run, "--mesh");
  if (path.empty()) return tell_mesh_crc32(entry);
  entry.subject.mesh = path;
  for (const char* option : {"--mesh-scale", "--mesh-up"})
    if (const std::string value = option_of(*entry.run, option); !value.empty())
      add_variant(entry, fmt::format("{} {}", option + 2, value));
}

void tell_inertia(Entry& entry) {
  const Eigen::Matrix3d inertia =
      entry.identity.subject.inertia_kg_m2.value_or(Eigen::Matrix3d(Eigen::Matrix3d::Zero()));
  add_variant(entry, fmt::format("inertia {},{},{},{},{},{}", inertia(0, 0), inertia(1, 1), inertia(2, 2),
                                 inertia(0, 1), inertia(0, 2), inertia(1, 2)));
}

constexpr Distinction kDistinctions[] = {
    {[](const auto& a, const auto& b) { return a.mesh_crc32 != b.mesh_crc32; }, tell_mesh},
    {[](const auto& a, const auto& b) { return a.subject.model_crc32 != b.subject.model_crc32; },
     [](Entry& entry) {
       add_variant(entry, fmt::format("model with CRC-32 {:08x}", entry.subject.model_crc32));
     }},
    {[](const auto& a, const auto& b) { return a.subject.inertia_kg_m2 != b.subject.inertia_kg_m2; },
     tell_inertia},
    {[](const auto& a, const auto& b) { return a.settings.frames != b.settings.frames; },
     [](Entry& entry) { add_variant(entry, counted(entry.identity.settings.frames, "frame")); }}};

bool is_one_subject(const ExperimentIdentity& a, const ExperimentIdentity& b) {
  return a.subject.target == b.subject.target && a.subject.mesh_name == b.subject.mesh_name &&
         std::none_of(std::begin(kDistinctions), std::end(kDistinctions),
                      [&](const Distinction& distinction) { return distinction.differs(a, b); });
}

// As before a run begins: workers can also be started by hand.
void require_new(const std::vector<std::pair<const CampaignRun*, ExperimentIdentity>>& runs) {
  for (std::size_t i = 0; i + 1 < runs.size(); ++i)
    if (has_same_sequences(runs[i].second, runs.back().second))
      throw std::runtime_error(fmt::format(
          "runs {} and {} have the same sequences, which would count twice; leave out one of them",
          runs[i].first->name, runs.back().first->name));
}

SubjectResult& subject_of(std::vector<Entry>& entries, const MergedShards& merged, const CampaignRun& run) {
  for (Entry& entry : entries)
    if (is_one_subject(entry.identity, merged.identity)) return entry.subject;
  const SubjectResult& figures = merged.figures;
  entries.push_back({{figures.target, figures.mesh, figures.model, figures.model_crc32, {}, {}, {}, {}, {}},
                     merged.identity,
                     &run});
  return entries.back().subject;
}

std::vector<std::string> titles_of(const std::vector<Entry>& entries) {
  std::vector<std::string> titles;
  for (const Entry& entry : entries) titles.push_back(title_of(entry.subject));
  return titles;
}

void make_titles_distinct(std::vector<Entry>& entries) {
  const std::vector<std::string> titles = titles_of(entries);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (const Distinction& distinction : kDistinctions) {
      bool needed = false;
      for (std::size_t j = 0; j < entries.size(); ++j)
        needed = needed ||
                 (titles[i] == titles[j] && distinction.differs(entries[i].identity, entries[j].identity));
      if (needed) distinction.tell(entries[i]);
    }
  }
  // A file that has changed between two runs has one name, too.
  const std::vector<std::string> told = titles_of(entries);
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (std::count(told.begin(), told.end(), told[i]) > 1) tell_mesh_crc32(entries[i]);
}

void add(SubjectResult& subject, CellResult&& cell) {
  const bool disturbed = !to_string(cell.disturbances).empty();
  auto& cells = differs_from_paper(cell) ? subject.sensor_runs
                : disturbed              ? subject.disturbed
                                         : subject.cells;
  cells.push_back(std::move(cell));
}

}  // namespace

Results campaign_results(const Campaign& campaign, const std::vector<CampaignTask>& tasks, MergeMode mode,
                         const std::function<void(std::size_t)>& progress) {
  Results results;
  std::vector<Entry> entries;
  std::vector<std::pair<const CampaignRun*, ExperimentIdentity>> runs;
  std::set<std::string> commits;
  for (std::size_t run = 0; run < campaign.runs.size(); ++run) {
    try {
      MergedShards merged = merge_shards(paths_of(tasks, run, mode), mode);
      runs.emplace_back(&campaign.runs[run], merged.identity);
      require_new(runs);
      commits.insert(merged.commits.begin(), merged.commits.end());
      results.seed = merged.identity.settings.seed;
      SubjectResult& subject = subject_of(entries, merged, campaign.runs[run]);
      for (CellResult& cell : merged.figures.cells) add(subject, std::move(cell));
      for (const std::string& note : merged.notes)
        results.notes.push_back(fmt::format("{}: {}", campaign.runs[run].name, note));
    } catch (const NothingDone&) {
      results.notes.push_back(fmt::format("{}: no sequence is done.", campaign.runs[run].name));
    }
    progress(run + 1);
  }
  make_titles_distinct(entries);
  for (Entry& entry : entries) results.subjects.push_back(std::move(entry.subject));
  note_builds(commits, results.notes);
  results.notes.push_back(
      fmt::format("Commands that show a sequence are for the folder {}.", campaign.folder));
  return results;
}

}  // namespace tumblesight::sim
