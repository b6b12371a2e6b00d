#include "sim/campaign/campaign_results.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sim/terminal/text.hpp"

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

// As the campaign file names it. A mission names its mesh itself.
void tell_mesh(Entry& entry) {
  const std::vector<std::string>& options = entry.run->options;
  const auto option = std::find(options.begin(), options.end(), "--mesh");
  if (option != options.end() && option + 1 != options.end())
    entry.subject.mesh = *(option + 1);
  else
    add_variant(entry, fmt::format("mesh with CRC-32 {:08x}", entry.identity.mesh_crc32));
}

void tell_inertia(Entry& entry) {
  const Eigen::Matrix3d inertia =
      entry.identity.subject.inertia_kg_m2.value_or(Eigen::Matrix3d(Eigen::Matrix3d::Zero()));
  add_variant(entry, fmt::format("inertia {:g},{:g},{:g},{:g},{:g},{:g}", inertia(0, 0), inertia(1, 1),
                                 inertia(2, 2), inertia(0, 1), inertia(0, 2), inertia(1, 2)));
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

SubjectResult& subject_of(std::vector<Entry>& entries, const MergedShards& merged, const CampaignRun& run) {
  for (Entry& entry : entries)
    if (is_one_subject(entry.identity, merged.identity)) return entry.subject;
  const SubjectResult& figures = merged.figures;
  entries.push_back({{figures.target, figures.mesh, figures.model, figures.model_crc32, {}, {}, {}, {}, {}},
                     merged.identity,
                     &run});
  return entries.back().subject;
}

void make_titles_distinct(std::vector<Entry>& entries) {
  std::vector<std::string> titles;
  for (const Entry& entry : entries) titles.push_back(title_of(entry.subject));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (const Distinction& distinction : kDistinctions) {
      bool needed = false;
      for (std::size_t j = 0; j < entries.size(); ++j)
        needed = needed ||
                 (titles[i] == titles[j] && distinction.differs(entries[i].identity, entries[j].identity));
      if (needed) distinction.tell(entries[i]);
    }
  }
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
  std::set<std::string> commits;
  for (std::size_t run = 0; run < campaign.runs.size(); ++run) {
    const std::vector<std::string> paths = paths_of(tasks, run, mode);
    if (paths.empty()) {
      results.notes.push_back(fmt::format("{}: no sequence is done.", campaign.runs[run].name));
    } else {
      MergedShards merged = merge_shards(paths, mode);
      commits.insert(merged.commits.begin(), merged.commits.end());
      results.seed = merged.identity.settings.seed;
      SubjectResult& subject = subject_of(entries, merged, campaign.runs[run]);
      for (CellResult& cell : merged.figures.cells) add(subject, std::move(cell));
      for (const std::string& note : merged.notes)
        results.notes.push_back(fmt::format("{}: {}", campaign.runs[run].name, note));
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
