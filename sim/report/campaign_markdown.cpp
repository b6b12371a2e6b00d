#include "sim/report/campaign_markdown.hpp"

#include <fmt/format.h>

#include "sim/report/data_table.hpp"
#include "sim/report/results_tables.hpp"

namespace tumblesight::sim {
namespace {

std::string introduction(const Results& results) {
  std::string text = fmt::format("# Campaign\n\nMade by\n\n```\n{}\n```\n\nwith seed {}.\n\n",
                                 results.command, results.seed);
  for (const std::string& note : results.notes) text += "- Note: " + note + "\n";
  return text;
}

std::string worst_section(const CellResult& cell) {
  if (cell.rare.worst.empty()) return {};
  std::string text = fmt::format("### Worst sequences, {}\n\n{}", run_name(cell),
                                 markdown_text(worst_sequences_table(cell)));
  if (!cell.replay.empty())
    text +=
        fmt::format("To see the worst:\n\n```\n{}{}\n```\n\n", cell.replay, cell.rare.worst.front().sequence);
  return text;
}

std::string subject_section(const SubjectResult& subject) {
  std::string text = fmt::format(
      "## {}\n\n`{}.tsm`, CRC-32 `{:08x}`\n\n{}**Last frames that went wrong, of all last frames.** The true "
      "rate is above the lower bound with probability 97.5 %, and below the upper one likewise "
      "(Clopper-Pearson).\n\n{}",
      title_of(subject), subject.model, subject.model_crc32, markdown_text(accuracy_table(subject)),
      markdown_text(rare_events_table(subject)));
  for (const CellResult* cell : all_cells(subject)) text += worst_section(*cell);
  return text;
}

}  // namespace

std::string campaign_markdown(const Results& results) {
  std::string text = introduction(results);
  for (const SubjectResult& subject : results.subjects) text += "\n" + subject_section(subject);
  while (text.size() > 1 && text[text.size() - 2] == '\n') text.pop_back();  // one line break at the end
  return text;
}

}  // namespace tumblesight::sim
