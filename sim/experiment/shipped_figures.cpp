#include "sim/experiment/shipped_figures.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sim/evaluation/statistics.hpp"
#include "sim/json/json_text.hpp"

namespace tumblesight::sim {
namespace {

using Json = nlohmann::json;

constexpr double kTolerance = 3.0;  // standard errors

// nlohmann's get() converts any number type to any other without a check.
template <class Integer>
Integer whole_number(const Json& row, const char* key) {
  const Json& value = row.at(key);
  constexpr std::uint64_t kLargest = std::numeric_limits<Integer>::max();
  if (value.is_number_unsigned() && value.get<std::uint64_t>() <= kLargest) return value.get<Integer>();
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

ShippedFigures figures_from(const Json& row) {
  ShippedFigures figures;
  figures.target = row.at("target").get<std::string>();
  figures.mesh = row.at("mesh").get<std::string>();
  figures.model_crc32 = crc32_from(row);
  figures.condition = condition_from(row.at("condition").get<std::string>());
  figures.frames = whole_number<std::uint32_t>(row, "frames");
  figures.seed = whole_number<std::uint64_t>(row, "seed");
  figures.rcnn = summary_from(row, "rcnn");
  figures.cnn = summary_from(row, "cnn");
  return figures;
}

// Standard error of the difference between the shipped run and one of `count` sequences, from the shipped
// run's standard error.
double difference_error(double shipped_error, std::size_t shipped_count, std::size_t count) {
  if (count == 0) return 0.0;
  return shipped_error * std::sqrt(1.0 + static_cast<double>(shipped_count) / static_cast<double>(count));
}

}  // namespace

std::vector<ShippedFigures> read_shipped_figures(const std::string& json, const std::string& name) {
  try {
    std::vector<ShippedFigures> all;
    const Json file = parse_json<Json>(json);
    for (const Json& row : file.at("rows")) all.push_back(figures_from(row));
    return all;
  } catch (const std::exception& error) {
    throw std::runtime_error(
        fmt::format("figures of a shipped model '{}': {}; write the file with tumblesight evaluate --json",
                    name, error.what()));
  }
}

double mean_tolerance_deg(const ErrorSummary& shipped, std::size_t count) {
  return kTolerance * difference_error(shipped.mean_standard_error_deg, shipped.count, count);
}

double share_tolerance(const ErrorSummary& shipped, std::size_t count) {
  const double shipped_error = share_standard_error(shipped.within_20deg, shipped.count);
  return kTolerance * difference_error(shipped_error, shipped.count, count);
}

std::string worse_than(const ErrorSummary& shipped, const ErrorSummary& run) {
  std::string text;
  const double mean_limit_deg = shipped.mean_deg + mean_tolerance_deg(shipped, run.count);
  if (!(run.mean_deg <= mean_limit_deg)) {
    text += fmt::format("mean error {} over {} sequences, shipped with {}, at most {} allowed; ",
                        degrees_text(run.mean_deg), run.count,
                        degrees_text(shipped.mean_deg, shipped.mean_standard_error_deg),
                        degrees_text(mean_limit_deg));
  }
  const double least_share = shipped.within_20deg - share_tolerance(shipped, run.count);
  if (!(run.within_20deg >= least_share)) {
    text += fmt::format("{} within 20° over {} sequences, shipped with {}, at least {} allowed; ",
                        percent_text(run.within_20deg), run.count,
                        percent_text(shipped.within_20deg, shipped.count), percent_text(least_share));
  }
  return text;
}

}  // namespace tumblesight::sim
