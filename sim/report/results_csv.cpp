#include "sim/report/results_csv.hpp"

#include "sim/report/results_columns.hpp"

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

}  // namespace tumblesight::sim
