#include "sim/cli/evaluation_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "gnc/numerics/crc.hpp"
#include "sim/cli/mesh_advice.hpp"
#include "sim/cli/symmetry_arguments.hpp"
#include "sim/evaluation/chance.hpp"
#include "sim/evaluation/checks.hpp"
#include "sim/host/text.hpp"
#include "sim/host/write_file.hpp"
#include "sim/report/error_tables.hpp"
#include "sim/report/results_files.hpp"
#include "sim/report/results_json.hpp"
#include "sim/report/results_tables.hpp"

namespace tumblesight::sim {
namespace {

std::string json_text(const Results& results) {
  return results_json(results).dump(2) + "\n";
}

// Of the JSON file, so that two runs can be compared without one.
std::uint32_t crc32_of(const Results& results) {
  const std::string text = json_text(results);
  return gnc::crc32(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

void print_cell(const SubjectResult& subject, const CellResult& cell) {
  if (subject.cells.size() > 1) fmt::print("\n  {}\n", to_string(cell.condition));
  fmt::print("\n{}\n{}\n", terminal_text(transposed(cell_table(subject.target, cell))),
             terminal_text(by_frame_table(cell.by_frame)));
  fmt::print("  step                 {:.2f} ms per frame (median, one thread)\n", cell.step_ms);
  if (cell.baseline) {
    fmt::print(
        "  template matching    {:.0f} ms per frame; templates of the same mesh as the frames, last {} "
        "of the first {}\n",
        cell.baseline_ms, cell.baseline->count == 1 ? "frame" : "frames",
        counted(cell.baseline->count, "sequence"));
  }
}

void print_curves(const SubjectResult& subject) {
  const Sweeps& sweeps = *subject.sweeps;
  fmt::print("\n{}\n{}\n{}\n{}\n", terminal_text(curve_table("range [m]", subject.cells.front().by_range)),
             terminal_text(curve_table("rate, components drawn [deg/s]", subject.cells.front().by_rate)),
             terminal_text(curve_table("rate, norm drawn [deg/s]", sweeps.by_rate_norm)),
             terminal_text(curve_table("hidden [%]", sweeps.by_hidden_share, 100.0)));
  for (const Check& check : checks_of(subject)) {
    fmt::print("  {}: {}{}\n", check.what, text_of(check), check.holds() ? "" : "  MISSED");
  }
}

}  // namespace

void add_results_options(Command& command, ResultsFiles& files) {
  command
      .add_option("--csv", files.csv, "write the figures to this file, one line per estimator and condition")
      ->check(file_path())
      ->type_name("FILE");
  add_json_option(command, files.json);
  add_report_option(command, files.report, "");
}

OptionFiles files_written(const ResultsFiles& files) {
  return {{"--json", files.json}, {"--csv", files.csv}, {"--report", files.report}};
}

void announce(const SubjectDescription& subject, const ExperimentSettings& settings) {
  std::string conditions;
  for (const Condition condition : settings.conditions) {
    conditions += (conditions.empty() ? "" : ", ") + to_string(condition);
  }
  fmt::print("\n  {}, {}, {} of {}, seed {}\n  mesh {}, model {}, CRC-32 {:08x}\n\n", subject.target,
             conditions, counted(settings.sequences, "sequence"), counted(settings.frames, "frame"),
             settings.seed, subject.mesh_name, subject.model_name, subject.model_crc32);
  print_sensor(subject.sensor, subject.ranges);
  print_symmetry(subject.symmetry);
  const std::string disturbances = to_string(settings.disturbances);
  if (!disturbances.empty()) fmt::print("  disturbed: {}\n\n", disturbances);
  const std::string effects = to_string(settings.effects);
  if (!effects.empty()) fmt::print("  effect: {}\n\n", effects);
  std::fflush(stdout);
}

void print_results(const Results& results) {
  const SubjectResult& subject = results.subjects.front();
  for (const CellResult& cell : subject.cells) print_cell(subject, cell);
  const DataTable poses = poses_table(subject);
  if (!poses.rows.empty()) fmt::print("\n{}", terminal_text(transposed(poses)));
  fmt::print("\n{}", terminal_text(transposed(rare_events_table(subject))));
  if (subject.sweeps) print_curves(subject);
  fmt::print("\n  figures, CRC-32      {:08x}\n", crc32_of(results));
}

void print_campaign(const Results& results) {
  constexpr std::size_t kShown = 3;
  for (const SubjectResult& subject : results.subjects) {
    fmt::print("\n  {}, model {}, CRC-32 {:08x}\n\n{}", title_of(subject), subject.model, subject.model_crc32,
               terminal_text(accuracy_table(subject)));
    fmt::print("\n{}", terminal_text(rare_events_table(subject)));
    for (const CellResult* cell : all_cells(subject)) {
      DataTable table = worst_sequences_table(*cell);
      table.rows.resize(std::min(table.rows.size(), kShown));
      fmt::print("\n  worst of {}; to see one: {}N\n\n{}", run_name(*cell), cell->replay,
                 terminal_text(table));
    }
  }
  fmt::print("\n  figures, CRC-32      {:08x}\n", crc32_of(results));
}

const CellResult* print_mostly_wrong(const SubjectResult& result) {
  const CellResult* first = nullptr;
  for (const CellResult& cell : result.cells) {
    if (!is_mostly_wrong(cell)) continue;
    fmt::print("\n{}", paragraph(fmt::format("Condition {}: {}", to_string(cell.condition),
                                             mostly_wrong_text(cell.rcnn, cell.symmetry))));
    if (first == nullptr) first = &cell;
  }
  return first;
}

void write_files(const ResultsFiles& files, const Results& results) {
  if (!files.json.empty()) write_file(files.json, json_text(results));
  if (!files.csv.empty()) write_file(files.csv, results_csv(results));
  if (!files.report.empty()) write_file(files.report, results_page(results));
}

void print_report_path(const ResultsFiles& files) {
  if (!files.report.empty()) fmt::print("  report               {}\n", full_path(files.report));
  fmt::print("\n");
}

}  // namespace tumblesight::sim
