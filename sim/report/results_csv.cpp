#include "sim/report/results_csv.hpp"

#include <fmt/format.h>

#include "sim/evaluation/statistics.hpp"

namespace tumblesight::sim {
namespace {

// Quoted where a comma, a quotation mark or a line break would break the line.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string estimator_line(const std::string& cell, const char* estimator, const ErrorSummary& summary,
                           const std::optional<PaperFigure>& paper) {
  std::string line = fmt::format("{},{},{}", cell, estimator, summary.count);
  if (summary.count == 0) {
    line += ",,,,,,,";
  } else {
    line += fmt::format(",{:.4f},{:.4f},{:.4f},{:.5f},{:.5f},{:.5f},{:.5f}", summary.mean_deg,
                        summary.mean_standard_error_deg, summary.median_deg, summary.within_20deg,
                        share_standard_error(summary.within_20deg, summary.count), summary.within_5deg,
                        share_standard_error(summary.within_5deg, summary.count));
  }
  return line + (paper ? fmt::format(",{},{}\n", paper->mean_deg, paper->within_20deg) : ",,\n");
}

}  // namespace

std::string results_csv(const Results& results) {
  std::string csv =
      "target,mesh,model,model_crc32,condition,frames,seed,estimator,sequences,mean_deg,mean_standard_error_"
      "deg,"
      "median_deg,within_20deg,within_20deg_standard_error,within_5deg,within_5deg_standard_error,paper_mean_"
      "deg,"
      "paper_within_20deg\n";
  for (const SubjectResult& subject : results.subjects) {
    for (const CellResult& cell : subject.cells) {
      const PaperFigures paper = paper_figures(subject.target, cell.condition);
      const std::string start = fmt::format("{},{},{},{:08x},{},{},{}", field(subject.target),
                                            field(subject.mesh), field(subject.model), subject.model_crc32,
                                            to_string(cell.condition), cell.frames, results.seed);
      csv += estimator_line(start, "rcnn", cell.rcnn, paper.rcnn);
      csv += estimator_line(start, "cnn", cell.cnn, paper.cnn);
      if (cell.baseline) csv += estimator_line(start, "baseline", *cell.baseline, std::nullopt);
    }
  }
  return csv;
}

}  // namespace tumblesight::sim
