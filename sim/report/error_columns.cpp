#include "sim/report/error_columns.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "sim/evaluation/statistics.hpp"

namespace tumblesight::sim {
namespace {

double mean_error(const ErrorSummary& summary) {
  return summary.mean_standard_error_deg;
}

// The error of a single sequence cannot be known.
std::string mean_text(const ErrorSummary& summary) {
  if (summary.count == 1) return degrees_text(summary.mean_deg);
  return degrees_text(summary.mean_deg, summary.mean_standard_error_deg);
}

// In tables the mean of all and the two shares of the same count carry the standard errors.
template <double ErrorSummary::*value>
std::string short_degrees_text(const ErrorSummary& summary) {
  return degrees_text(summary.*value);
}

template <double ErrorSummary::*share>
std::string short_share_text(const ErrorSummary& summary) {
  return percent_text(summary.*share);
}

double mean_within_20_error(const ErrorSummary& summary) {
  return summary.mean_within_20_standard_error_deg;
}

std::string median_text(const ErrorSummary& summary) {
  return degrees_text(summary.median_deg);
}

template <double ErrorSummary::*share>
double share_error(const ErrorSummary& summary) {
  return share_standard_error(summary.*share, summary.count);
}

template <double ErrorSummary::*share>
std::string share_text(const ErrorSummary& summary) {
  return percent_text(summary.*share, summary.count);
}

std::string paper_degrees(double deg) {
  return degrees_text(deg);
}

std::string paper_percent(double share) {
  return fmt::format("{:.3g} %", 100.0 * share);
}

std::string millimetres_text(double metres) {
  return fmt::format("{:.1f} mm", 1e3 * metres);
}

std::string rate_text(double deg_s) {
  return fmt::format("{:.3f}°/s", deg_s);
}

std::string velocity_text(double m_s) {
  return fmt::format("{:.1f} mm/s", 1e3 * m_s);
}

std::string share_of_poses_text(double share) {
  return percent_text(share);
}

// A pose is some ten times as sharp as the network's attitude.
std::string pose_degrees_text(double deg) {
  return fmt::format("{:.3f}°", deg);
}

}  // namespace

const std::vector<SummaryFigure>& summary_figures() {
  static const std::vector<SummaryFigure> figures{
      {"mean_deg", "mean_standard_error_deg", true, "mean", 4, &ErrorSummary::mean_deg, mean_error, mean_text,
       &PaperFigure::mean_deg, paper_degrees},
      {"median_deg", nullptr, true, "median", 4, &ErrorSummary::median_deg, nullptr, median_text, nullptr,
       nullptr},
      {"within_20deg", "within_20deg_standard_error", false, "within 20°", 5, &ErrorSummary::within_20deg,
       share_error<&ErrorSummary::within_20deg>, share_text<&ErrorSummary::within_20deg>,
       &PaperFigure::within_20deg, paper_percent},
      {"within_5deg", "within_5deg_standard_error", false, "within 5°", 5, &ErrorSummary::within_5deg,
       share_error<&ErrorSummary::within_5deg>, share_text<&ErrorSummary::within_5deg>, nullptr, nullptr},
      {"mean_within_20_deg", "mean_within_20_standard_error_deg", true, "mean within 20°", 4,
       &ErrorSummary::mean_within_20_deg, mean_within_20_error,
       short_degrees_text<&ErrorSummary::mean_within_20_deg>, nullptr, nullptr},
      {"wrong_and_valid", "wrong_and_valid_standard_error", false, "wrong, valid", 5,
       &ErrorSummary::wrong_and_valid, share_error<&ErrorSummary::wrong_and_valid>,
       short_share_text<&ErrorSummary::wrong_and_valid>, nullptr, nullptr},
      {"right_and_valid", "right_and_valid_standard_error", false, "right, valid", 5,
       &ErrorSummary::right_and_valid, share_error<&ErrorSummary::right_and_valid>,
       short_share_text<&ErrorSummary::right_and_valid>, nullptr, nullptr}};
  return figures;
}

const SummaryFigure& summary_figure(double ErrorSummary::*value) {
  for (const SummaryFigure& figure : summary_figures()) {
    if (figure.value == value) return figure;
  }
  throw std::out_of_range("an error figure that is not in summary_figures()");
}

const std::vector<PoseFigure>& pose_figures() {
  static const std::vector<PoseFigure> figures{
      {"mean_deg", nullptr, false, 4, &PoseSummary::mean_deg, pose_degrees_text},
      {"mean_within_20_deg", "mean within 20°", true, 4, &PoseSummary::mean_within_20_deg, pose_degrees_text},
      {"median_deg", "median", false, 4, &PoseSummary::median_deg, pose_degrees_text},
      {"within_20deg", "within 20°", true, 5, &PoseSummary::within_20deg, share_of_poses_text},
      {"across_m", "across", false, 5, &PoseSummary::across_m, millimetres_text},
      {"along_m", "along", false, 5, &PoseSummary::along_m, millimetres_text},
      {"rate_deg_s", "rate", false, 4, &PoseSummary::rate_deg_s, rate_text},
      {"velocity_m_s", "velocity", false, 5, &PoseSummary::velocity_m_s, velocity_text},
      {"verified", "verified", false, 5, &PoseSummary::verified, share_of_poses_text},
      {"verified_wrong", "verified, wrong", false, 5, &PoseSummary::verified_wrong, share_of_poses_text},
      {"inside_95", "inside 95 %", false, 5, &PoseSummary::inside_95, share_of_poses_text}};
  return figures;
}

TableCell pose_cell(const PoseFigure& figure, const PoseSummary& summary) {
  const double value = summary.*figure.value;
  if (!(summary.known > 0.0) || std::isnan(value)) return {"-"};
  return {figure.text(value)};
}

TableCell figure_cell(const SummaryFigure& figure, const ErrorSummary& summary, Mark mark) {
  if (summary.count == 0 || std::isnan(summary.*figure.value)) return {"-"};
  return {figure.text(summary), mark};
}

TableCell paper_cell(const SummaryFigure& figure, const PaperFigure& paper) {
  if (figure.paper == nullptr) return {"-"};
  return {figure.paper_text(paper.*figure.paper), Mark::kPaper};
}

std::string paper_text(const std::optional<PaperFigure>& figure) {
  if (!figure) return "-";
  std::string text;
  for (const SummaryFigure& column : summary_figures()) {
    if (column.paper != nullptr) text += (text.empty() ? "" : ", ") + paper_cell(column, *figure).text;
  }
  return text;
}

}  // namespace tumblesight::sim
