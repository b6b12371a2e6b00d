#include "sim/evaluation/record.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sim/evaluation/statistics.hpp"

namespace tumblesight::sim {
namespace {

using Json = nlohmann::json;

constexpr double kTolerance = 3.0;  // standard errors

// nlohmann's own get() makes any number of any other.
template <class Whole>
Whole whole_number(const Json& row, const char* key) {
  const Json& value = row.at(key);
  constexpr std::uint64_t kLargest = std::numeric_limits<Whole>::max();
  if (value.is_number_unsigned() && value.get<std::uint64_t>() <= kLargest) return value.get<Whole>();
  throw std::runtime_error(
      fmt::format("{} must be a whole number up to {}, not {}", key, kLargest, value.dump()));
}

std::uint32_t crc32_from(const Json& row) {
  const std::string text = row.at("model_crc32").get<std::string>();
  const char* const last = text.data() + text.size();
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), last, value, 16);
  if (text.size() == 8 && error == std::errc{} && end == last) return value;
  throw std::runtime_error("model_crc32 must be eight hexadecimal digits, not '" + text + "'");
}

ErrorSummary summary_from(const Json& row, const char* estimator) {
  const Json& figures = row.at(estimator);
  ErrorSummary summary;
  summary.count = whole_number<std::size_t>(row, "sequences");
  summary.mean_deg = figures.at("mean_deg").get<double>();
  summary.mean_standard_error_deg = figures.at("mean_standard_error_deg").get<double>();
  summary.within_20deg = figures.at("within_20deg").get<double>();
  return summary;
}

Record record_from(const Json& row) {
  Record record;
  record.target = row.at("target").get<std::string>();
  record.mesh = row.at("mesh").get<std::string>();
  record.model_crc32 = crc32_from(row);
  record.condition = condition_from(row.at("condition").get<std::string>());
  record.frames = whole_number<std::uint32_t>(row, "frames");
  record.seed = whole_number<std::uint64_t>(row, "seed");
  record.rcnn = summary_from(row, "rcnn");
  record.cnn = summary_from(row, "cnn");
  return record;
}

// Of the difference between a run of as many sequences as recorded and one of `count`, from the recorded
// run's own standard error.
double difference_error(double recorded_error, std::size_t recorded_count, std::size_t count) {
  if (count == 0) return 0.0;
  return recorded_error * std::sqrt(1.0 + static_cast<double>(recorded_count) / static_cast<double>(count));
}

}  // namespace

std::vector<Record> read_records(const std::string& json, const std::string& name) {
  try {
    std::vector<Record> records;
    const Json file = Json::parse(json);
    for (const Json& row : file.at("rows")) records.push_back(record_from(row));
    return records;
  } catch (const std::exception& error) {
    throw std::runtime_error(
        fmt::format("record '{}': {}; write it with tumblesight evaluate --json", name, error.what()));
  }
}

double mean_tolerance_deg(const ErrorSummary& recorded, std::size_t count) {
  return kTolerance * difference_error(recorded.mean_standard_error_deg, recorded.count, count);
}

double share_tolerance(const ErrorSummary& recorded, std::size_t count) {
  const double recorded_error = share_standard_error(recorded.within_20deg, recorded.count);
  return kTolerance * difference_error(recorded_error, recorded.count, count);
}

std::string worse_than(const ErrorSummary& recorded, const ErrorSummary& run) {
  std::string text;
  const double mean_limit_deg = recorded.mean_deg + mean_tolerance_deg(recorded, run.count);
  if (!(run.mean_deg <= mean_limit_deg)) {
    text += fmt::format("mean error {} over {} sequences, recorded {}, at most {} allowed; ",
                        degrees_text(run.mean_deg), run.count,
                        degrees_text(recorded.mean_deg, recorded.mean_standard_error_deg),
                        degrees_text(mean_limit_deg));
  }
  const double least_share = recorded.within_20deg - share_tolerance(recorded, run.count);
  if (!(run.within_20deg >= least_share)) {
    text += fmt::format("{} within 20° over {} sequences, recorded {}, at least {} allowed; ",
                        percent_text(run.within_20deg), run.count,
                        percent_text(recorded.within_20deg, recorded.count), percent_text(least_share));
  }
  return text;
}

}  // namespace tumblesight::sim
