#include "sim/evaluation/charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumblesight::sim {
namespace {

constexpr double kWidth = 520.0;
constexpr double kHeight = 320.0;
constexpr double kLeft = 52.0;
constexpr double kRight = 508.0;
constexpr double kTop = 34.0;
constexpr double kBottom = 272.0;
constexpr double kCharacterWidth = 7.1;  // of a legend's text, about
const Stroke kGrid{"#e4e6ea", 1.0, "", 1.0};
const Stroke kAxis{"#8a9099", 1.0, "", 1.0};

// Data to user units along one axis.
struct Scale {
  double low;
  double high;
  double from;
  double to;
  bool logarithmic = false;

  double operator()(double value) const {
    const double clamped = std::clamp(value, low, high);
    const double share =
        logarithmic ? std::log(clamped / low) / std::log(high / low) : (clamped - low) / (high - low);
    return from + share * (to - from);
  }
};

std::string number_text(double value) {
  return fmt::format("{:g}", std::abs(value) < 1e-12 ? 0.0 : value);
}

void draw_y_axis(Svg& svg, const Scale& y, const std::vector<double>& ticks, const std::string& label) {
  for (const double tick : ticks) {
    svg.line({kLeft, y(tick)}, {kRight, y(tick)}, kGrid);
    svg.text({kLeft - 7.0, y(tick) + 4.0}, number_text(tick), {"end", 11.5, "#5a6069"});
  }
  svg.text({14.0, 0.5 * (kTop + kBottom)}, label, {"middle", 12.0, "#3c4149", false, -90.0});
}

void draw_x_label(Svg& svg, const std::string& label) {
  svg.line({kLeft, kBottom}, {kRight, kBottom}, kAxis);
  svg.text({0.5 * (kLeft + kRight), kHeight - 10.0}, label, {"middle", 12.0, "#3c4149"});
}

void draw_x_ticks(Svg& svg, const Scale& x, const std::vector<double>& ticks) {
  for (const double tick : ticks) {
    svg.line({x(tick), kBottom}, {x(tick), kBottom + 4.0}, kAxis);
    svg.text({x(tick), kBottom + 18.0}, number_text(tick), {"middle", 11.5, "#5a6069"});
  }
}

void draw_key(Svg& svg, Point at, const Series& series) {
  if (series.markers) {
    svg.circle({at.x + 12.0, at.y}, 4.0, series.colour, 0.8);
  } else if (series.points.size() == 1) {
    svg.ring({at.x + 12.0, at.y}, 4.5, {series.colour, 1.6, "", 1.0});
  } else {
    svg.line({at.x, at.y}, {at.x + 24.0, at.y}, {series.colour, 2.2, series.dash, 1.0});
  }
}

// Series without a name go with a named one.
void draw_legend(Svg& svg, const std::vector<Series>& series) {
  double x = kLeft;
  for (const Series& entry : series) {
    if (entry.name.empty()) continue;
    draw_key(svg, {x, 14.0}, entry);
    svg.text({x + 29.0, 18.0}, entry.name, {"start", 11.5, "#2b2f36"});
    x += 41.0 + kCharacterWidth * static_cast<double>(entry.name.size());
  }
}

void draw_series(Svg& svg, const Scale& x, const Scale& y, const Series& series) {
  std::vector<Point> points;
  for (const Point& point : series.points) points.push_back({x(point.x), y(point.y)});
  if (series.markers) {
    for (const Point& point : points) svg.circle(point, 2.6, series.colour, 0.45);
  } else if (points.size() == 1) {
    svg.ring(points.front(), 5.0, {series.colour, 1.8, "", 1.0});
  } else {
    svg.polyline(points, {series.colour, 2.2, series.dash, 1.0});
  }
}

double largest_y(const std::vector<Series>& series) {
  double largest = 0.0;
  for (const Series& entry : series) {
    for (const Point& point : entry.points) largest = std::max(largest, point.y);
  }
  return largest;
}

void draw_bar_group(Svg& svg, const BarChart& chart, const Scale& y, const BarGroup& group, double left,
                    double width) {
  const double bar = 0.8 * width / static_cast<double>(chart.series_names.size());
  for (std::size_t i = 0; i < group.values.size(); ++i) {
    const double top = y(group.values[i]);
    const double x = left + 0.1 * width + static_cast<double>(i) * bar;
    svg.rectangle({x + 0.5, top}, bar - 1.0, kBottom - top, chart.series_colours[i]);
  }
  svg.text({left + 0.5 * width, kBottom + 18.0}, group.name, {"middle", 11.5, "#5a6069"});
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int count) {
  const double rough = (high - low) / std::max(1, count);
  if (!(rough > 0.0)) return {low};
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= rough * 0.999) step = factor * power;
  }
  std::vector<double> ticks;
  const auto first = static_cast<int>(std::floor(low / step + 1e-9));
  for (int i = first; ticks.empty() || ticks.back() < high - 1e-9 * step; ++i) ticks.push_back(i * step);
  return ticks;
}

std::string line_chart(const LineChart& chart) {
  Svg svg(kWidth, kHeight, chart.description);
  const double y_high = chart.y_high > chart.y_low ? chart.y_high : std::max(1.0, largest_y(chart.series));
  const std::vector<double> y_ticks = round_ticks(chart.y_low, y_high, 5);
  const Scale x{chart.x_low, chart.x_high, kLeft + 8.0, kRight - 8.0};
  const Scale y{y_ticks.front(), y_ticks.back(), kBottom, kTop};
  draw_y_axis(svg, y, y_ticks, chart.y_label);
  std::vector<double> x_ticks;
  const double x_step = std::max(1.0, std::ceil((chart.x_high - chart.x_low) / 12.0));
  for (double tick = chart.x_low; tick <= chart.x_high; tick += x_step) x_ticks.push_back(tick);
  draw_x_ticks(svg, x, x_ticks);
  draw_x_label(svg, chart.x_label);
  for (const Series& series : chart.series) draw_series(svg, x, y, series);
  draw_legend(svg, chart.series);
  return svg.text();
}

std::string bar_chart(const BarChart& chart) {
  Svg svg(kWidth, kHeight, chart.description);
  double highest = 1.0;
  for (const BarGroup& group : chart.groups) {
    for (const double value : group.values) highest = std::max(highest, value);
  }
  const std::vector<double> ticks = round_ticks(0.0, highest, 5);
  const Scale y{0.0, ticks.back(), kBottom, kTop};
  draw_y_axis(svg, y, ticks, chart.y_label);
  const double width = (kRight - kLeft) / static_cast<double>(std::max<std::size_t>(1, chart.groups.size()));
  for (std::size_t i = 0; i < chart.groups.size(); ++i) {
    draw_bar_group(svg, chart, y, chart.groups[i], kLeft + static_cast<double>(i) * width, width);
  }
  draw_x_label(svg, chart.x_label);
  double x = kLeft;
  for (std::size_t i = 0; i < chart.series_names.size(); ++i) {
    svg.rectangle({x, 9.0}, 11.0, 11.0, chart.series_colours[i]);
    svg.text({x + 16.0, 18.0}, chart.series_names[i], {"start", 11.5, "#2b2f36"});
    x += 34.0 + kCharacterWidth * static_cast<double>(chart.series_names[i].size());
  }
  return svg.text();
}

std::string agreement_chart(const AgreementChart& chart) {
  Svg svg(kWidth, kHeight, chart.description);
  const Scale x{chart.low, chart.high, kLeft, kRight, true};
  const Scale y{chart.low, chart.high, kBottom, kTop, true};
  std::vector<double> ticks;
  for (const double tick : {0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 90.0, 180.0}) {
    if (tick >= chart.low && tick <= chart.high) ticks.push_back(tick);
  }
  draw_y_axis(svg, y, ticks, chart.y_label);
  for (const double tick : ticks) svg.line({x(tick), kTop}, {x(tick), kBottom}, kGrid);
  draw_x_ticks(svg, x, ticks);
  draw_x_label(svg, chart.x_label);
  svg.line({x(chart.low), y(chart.low)}, {x(chart.high), y(chart.high)}, {"#8a9099", 1.2, "5 4", 1.0});
  for (const Series& series : chart.series) draw_series(svg, x, y, series);
  draw_legend(svg, chart.series);
  return svg.text();
}

}  // namespace tumblesight::sim
