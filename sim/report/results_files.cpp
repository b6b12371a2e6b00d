#include "sim/report/results_files.hpp"

#include "sim/report/results_columns.hpp"
#include "sim/report/results_json.hpp"
#include "sim/terminal/write_file.hpp"

namespace tumblesight::sim {

std::string results_csv(const Results& results) {
  std::string csv;
  const char* separator = "";
  for (const CsvColumn& column : csv_columns()) {
    csv += separator + column.name;
    separator = ",";
  }
  for (const EstimatorRow& row : estimator_rows(results)) {
    separator = "\n";
    for (const CsvColumn& column : csv_columns()) {
      csv += separator + column.field(row);
      separator = ",";
    }
  }
  return csv + "\n";
}

void write_results_files(const std::string& folder, const Results& results) {
  write_file(folder + "/results.md", results_markdown(results));
  write_file(folder + "/results.csv", results_csv(results));
  write_file(folder + "/results.json", results_json(results).dump(2) + "\n");
  write_file(folder + "/report.html", results_page(results));
}

}  // namespace tumblesight::sim
