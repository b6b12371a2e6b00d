#include "sim/campaign/campaign_results.hpp"

#include <fmt/format.h>

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

SubjectResult& subject_of(std::vector<SubjectResult>& subjects, const SubjectResult& figures) {
  for (SubjectResult& subject : subjects) {
    if (subject.target == figures.target && subject.mesh == figures.mesh &&
        subject.model_crc32 == figures.model_crc32)
      return subject;
  }
  return subjects.emplace_back(
      SubjectResult{figures.target, figures.mesh, figures.model, figures.model_crc32, {}, {}, {}, {}});
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
  std::set<std::string> commits;
  for (std::size_t run = 0; run < campaign.runs.size(); ++run) {
    const std::vector<std::string> paths = paths_of(tasks, run, mode);
    if (paths.empty()) {
      results.notes.push_back(fmt::format("{}: no sequence is done.", campaign.runs[run].name));
    } else {
      MergedShards merged = merge_shards(paths, mode);
      commits.insert(merged.commits.begin(), merged.commits.end());
      results.seed = merged.identity.settings.seed;
      SubjectResult& subject = subject_of(results.subjects, merged.figures);
      for (CellResult& cell : merged.figures.cells) add(subject, std::move(cell));
      for (const std::string& note : merged.notes)
        results.notes.push_back(fmt::format("{}: {}", campaign.runs[run].name, note));
    }
    progress(run + 1);
  }
  note_builds(commits, results.notes);
  results.notes.push_back(
      fmt::format("Commands that show a sequence are for the folder {}.", campaign.folder));
  return results;
}

}  // namespace tumblesight::sim
