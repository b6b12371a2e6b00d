#include "sim/training/training_log.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace tumblesight::sim {
namespace {

constexpr const char* kHeader =
    "stage,iteration,samples,seconds,learning_rate,loss,best_hypothesis_deg,mean_deg,median_deg,within_20deg";

std::string to_csv(const TrainingPoint& p) {
  char line[256];
  std::snprintf(line, sizeof line, "%s,%lld,%lld,%.1f,%.3e,%.5f,%.3f,%.3f,%.3f,%.4f", p.stage.c_str(),
                static_cast<long long>(p.iteration), static_cast<long long>(p.samples), p.seconds,
                p.learning_rate, p.loss, p.best_deg, p.mean_deg, p.median_deg, p.within_20deg);
  return line;
}

bool from_csv(std::string line, TrainingPoint& p) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream in(line);
  return static_cast<bool>(in >> p.stage >> p.iteration >> p.samples >> p.seconds >> p.learning_rate >>
                           p.loss >> p.best_deg >> p.mean_deg >> p.median_deg >> p.within_20deg);
}

// Both stages share one axis of time; errors on a logarithmic scale from 1 to 180 degrees.
struct Axes {
  double width = 760, height = 360, left = 56, top = 24, bottom = 44, hours = 1.0;
  double x(double h) const { return left + (width - left - 16) * h / hours; }
  double y(double deg) const {
    const double f = std::log(std::clamp(deg, 1.0, 180.0)) / std::log(180.0);
    return height - bottom - (height - top - bottom) * f;
  }
};

std::string polyline(const Axes& axes, const std::vector<std::pair<double, double>>& points,
                     const char* color) {
  std::ostringstream out;
  out << "<polyline fill='none' stroke-width='1.8' stroke='" << color << "' points='";
  for (const auto& [hours, degrees] : points) out << axes.x(hours) << ',' << axes.y(degrees) << ' ';
  out << "'/>\n";
  return out.str();
}

std::string frame(const Axes& axes) {
  std::ostringstream out;
  for (const double degrees : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 180.0}) {
    out << "<line x1='" << axes.left << "' x2='" << axes.width - 16 << "' y1='" << axes.y(degrees) << "' y2='"
        << axes.y(degrees) << "' stroke='#ddd'/><text x='" << axes.left - 6 << "' y='" << axes.y(degrees) + 4
        << "' text-anchor='end'>" << degrees << "°</text>\n";
  }
  for (int i = 0; i <= 4; ++i) {
    const double hours = axes.hours * i / 4;
    char label[32];
    std::snprintf(label, sizeof label, "%.0f min", hours * 60);
    out << "<text text-anchor='" << (i == 4 ? "end" : "middle") << "' x='" << axes.x(hours) << "' y='"
        << axes.height - axes.bottom + 18 << "'>" << label << "</text>\n";
  }
  return out.str();
}

}  // namespace

TrainingLog::TrainingLog(const std::string& folder, const std::string& stage, std::int64_t last_iteration)
    : folder_(folder) {
  std::ifstream in(folder + "/log.csv");
  TrainingPoint point;
  for (std::string line; std::getline(in, line);) {
    if (from_csv(line, point) && (point.stage != stage || point.iteration <= last_iteration))
      points_.push_back(point);
  }
  in.close();
  const std::string fresh = folder + "/log.csv.new";  // a kill leaves the old log or the new one whole
  std::ofstream out(fresh);
  if (!out) throw std::runtime_error("cannot write " + folder + "/log.csv: choose another folder with --out");
  out << kHeader << '\n';
  for (const TrainingPoint& p : points_) out << to_csv(p) << '\n';
  out.close();
  std::filesystem::rename(fresh, folder + "/log.csv");
}

void TrainingLog::add(const TrainingPoint& point) {
  points_.push_back(point);
  std::ofstream(folder_ + "/log.csv", std::ios::app) << to_csv(point) << '\n';
  draw();
}

void TrainingLog::draw() const {
  double cnn_hours = 0.0;
  for (const TrainingPoint& p : points_) {
    if (p.stage == "cnn") cnn_hours = std::max(cnn_hours, p.seconds / 3600.0);
  }
  std::vector<std::pair<double, double>> cnn, best, rcnn;
  Axes axes;
  axes.hours = 1e-3;
  for (const TrainingPoint& p : points_) {
    const bool single = p.stage == "cnn";
    const double hours = p.seconds / 3600.0 + (single ? 0.0 : cnn_hours);
    axes.hours = std::max(axes.hours, hours);
    (single ? cnn : rcnn).emplace_back(hours, p.mean_deg);
    if (single) best.emplace_back(hours, p.best_deg);
  }
  std::ofstream out(folder_ + "/curve.svg");
  out << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 760 360' font-family='sans-serif' "
         "font-size='12'>\n"
      << "<rect width='760' height='360' fill='white'/>\n"
      << frame(axes) << polyline(axes, cnn, "#c2571a") << polyline(axes, best, "#e8b48c")
      << polyline(axes, rcnn, "#1f5fa8")
      << "<text x='64' y='16'>Validation error over training time: <tspan fill='#c2571a'>single frame "
         "(CNN)</tspan>, "
         "<tspan fill='#e8b48c'>its best hypothesis</tspan>, <tspan fill='#1f5fa8'>RCNN, last "
         "frame</tspan></text>\n"
      << "</svg>\n";
}

bool ProgressLine::due() {
  const auto period = std::chrono::milliseconds(isatty(STDERR_FILENO) != 0 ? 500 : 30000);
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < period) return false;
  last_ = now;
  return true;
}

void ProgressLine::show(const std::string& stage, std::int64_t done, std::int64_t total, double per_second,
                        const char* unit, double loss, double validation_deg) {
  if (!due()) return;
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const double left_s = per_second > 0.0 ? static_cast<double>(total - done) / per_second : 0.0;
  std::fprintf(stderr,
               "%s%s %5.1f %%  %lld / %lld %s  %.0f %s/s  loss %.4f  validation %.2f deg  %.0f min left%s",
               terminal ? "\r\033[K" : "", stage.c_str(),
               100.0 * static_cast<double>(done) / static_cast<double>(total), static_cast<long long>(done),
               static_cast<long long>(total), unit, per_second, unit, loss, validation_deg, left_s / 60.0,
               terminal ? "" : "\n");
}

void ProgressLine::wait(const std::string& stage, const char* for_what, std::int64_t done,
                        std::int64_t total) {
  if (!due()) return;
  const bool terminal = isatty(STDERR_FILENO) != 0;
  std::fprintf(stderr, "%s%s  waiting for %s: %lld of %lld%s", terminal ? "\r\033[K" : "", stage.c_str(),
               for_what, static_cast<long long>(done), static_cast<long long>(total), terminal ? "" : "\n");
}

void ProgressLine::finish() {
  if (isatty(STDERR_FILENO) != 0) std::fputc('\n', stderr);
}

}  // namespace tumblesight::sim
