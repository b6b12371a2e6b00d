#include "sim/report/results_files.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "sim/host/write_file.hpp"
#include "sim/report/results_columns.hpp"
#include "sim/report/results_json.hpp"

namespace tumblesight::sim {
namespace {

std::vector<CsvColumn> columns_of(const std::vector<EstimatorRow>& rows) {
  std::vector<CsvColumn> columns = csv_columns();
  const auto unused = [&](const CsvColumn& column) {
    return column.used != nullptr &&
           std::none_of(rows.begin(), rows.end(), [&](const EstimatorRow& row) { return column.used(row); });
  };
  columns.erase(std::remove_if(columns.begin(), columns.end(), unused), columns.end());
  return columns;
}

}  // namespace

std::string results_csv(const Results& results) {
  const std::vector<EstimatorRow> rows = estimator_rows(results);
  const std::vector<CsvColumn> columns = columns_of(rows);
  std::string csv;
  const char* separator = "";
  for (const CsvColumn& column : columns) {
    csv += separator + column.name;
    separator = ",";
  }
  for (const EstimatorRow& row : rows) {
    separator = "\n";
    for (const CsvColumn& column : columns) {
      csv += separator + column.field(row);
      separator = ",";
    }
  }
  return csv + "\n";
}

void write_results_files(const std::string& folder, const Results& results, const std::string& markdown) {
  write_file(folder + "/results.md", markdown);
  write_file(folder + "/results.csv", results_csv(results));
  write_file(folder + "/results.json", results_json(results).dump(2) + "\n");
  write_file(folder + "/report.html", results_page(results));
}

}  // namespace tumblesight::sim
