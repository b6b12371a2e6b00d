// The columns of results, each described once: CSV, terminal, Markdown and HTML go by these lists, so that a
// new column is one new entry here. The figures are those of error_columns.hpp.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/evaluation/results.hpp"
#include "sim/report/data_table.hpp"
#include "sim/report/error_columns.hpp"

namespace tumblesight::sim {

// One estimator under one condition: a line of the CSV file. Holds references into the results.
struct EstimatorRow {
  const Results& results;
  const SubjectResult& subject;
  const CellResult& cell;
  const char* estimator;  // "rcnn", "cnn" or "baseline"
  const ErrorSummary& summary;
  std::optional<PaperFigure> paper;
};
std::vector<EstimatorRow> estimator_rows(const Results& results);

struct CsvColumn {
  std::string name;
  std::function<std::string(const EstimatorRow&)> field;  // empty text: there is no such figure
  // Whether a line has something in it; a file without such a line leaves the column out. nullptr: every file
  // has it.
  bool (*used)(const EstimatorRow&) = nullptr;
};
const std::vector<CsvColumn>& csv_columns();

// One condition of one network on one mesh: a line of the tables. Holds references into the results.
struct ResultRow {
  const SubjectResult& subject;
  const CellResult& cell;
  PaperFigures paper;
};
std::vector<ResultRow> condition_rows(const SubjectResult& subject);

// The tables with a line per condition, as a set of bits.
using ConditionTables = std::uint32_t;
inline constexpr ConditionTables kTerminalOverview = 1;  // narrow
inline constexpr ConditionTables kPageOverview = 2;
inline constexpr ConditionTables kAccuracyTable = 4;         // of the RCNN, in full
inline constexpr ConditionTables kOtherEstimatorsTable = 8;  // CNN, template matching, times
inline constexpr ConditionTables kOverviews = kTerminalOverview | kPageOverview;

struct ConditionColumn {
  ConditionTables tables;  // that show it
  std::string heading;
  std::function<TableCell(const ResultRow&)> cell;
};
// In their order from left to right.
const std::vector<ConditionColumn>& condition_columns();

}  // namespace tumblesight::sim
