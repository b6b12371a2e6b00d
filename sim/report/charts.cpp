#include "sim/report/charts.hpp"

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
constexpr double kLegendRow = 17.0;
constexpr double kCharacterWidth = 6.6;  // of legend text, approximately
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

// Places the entries of a legend in rows from the left. Names are UTF-8.
class LegendRows {
 public:
  Point place(const std::string& name, double key_width) {
    const auto characters = std::count_if(
        name.begin(), name.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
    const double width = key_width + 12.0 + kCharacterWidth * static_cast<double>(characters);
    if (x_ > kLeft && x_ + width > kRight + 12.0) {
      x_ = kLeft;
      ++row_;
    }
    const Point at{x_, 14.0 + kLegendRow * row_};
    x_ += width;
    return at;
  }
  double height() const { return kLegendRow * row_; }  // of the rows below the first

 private:
  double x_ = kLeft;
  int row_ = 0;
};

// A series without a name belongs to a named one and has no entry. Returns the height of the rows below the
// first.
double draw_legend(Svg& svg, const std::vector<Series>& series) {
  LegendRows rows;
  for (const Series& entry : series) {
    if (entry.name.empty()) continue;
    const Point at = rows.place(entry.name, 29.0);
    draw_key(svg, at, entry);
    svg.text({at.x + 29.0, at.y + 4.0}, entry.name, {"start", 11.5, "#2b2f36"});
  }
  return rows.height();
}

// Clamped to the axis.
void draw_error_bars(Svg& svg, const Scale& x, const Scale& y, const Series& series) {
  for (std::size_t i = 0; i < std::min(series.error_bars.size(), series.points.size()); ++i) {
    const Point& point = series.points[i];
    const double high = y(point.y + series.error_bars[i]);
    const double low = y(point.y - series.error_bars[i]);
    const Stroke stroke{series.colour, 1.2, "", 0.7};
    svg.line({x(point.x), high}, {x(point.x), low}, stroke);
    svg.line({x(point.x) - 3.0, high}, {x(point.x) + 3.0, high}, stroke);
    svg.line({x(point.x) - 3.0, low}, {x(point.x) + 3.0, low}, stroke);
  }
}

void draw_series(Svg& svg, const Scale& x, const Scale& y, const Series& series) {
  std::vector<Point> points;
  for (const Point& point : series.points) points.push_back({x(point.x), y(point.y)});
  draw_error_bars(svg, x, y, series);
  if (series.markers) {
    for (const Point& point : points) svg.circle(point, 2.6, series.colour, 0.45);
  } else if (points.size() == 1) {
    svg.ring(points.front(), 5.0, {series.colour, 1.8, "", 1.0});
  } else {
    svg.polyline(points, {series.colour, 2.2, series.dash, 1.0});
    if (series.error_bars.empty()) return;
    for (const Point& point : points) svg.circle(point, 3.0, series.colour);
  }
}

double largest_y(const std::vector<Series>& series) {
  double largest = 0.0;
  for (const Series& entry : series) {
    for (std::size_t i = 0; i < entry.points.size(); ++i) {
      const double bar = i < entry.error_bars.size() ? entry.error_bars[i] : 0.0;
      largest = std::max(largest, entry.points[i].y + bar);
    }
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

// Pale for 0, dark for 1. The square root makes small shares visible.
void draw_share(Svg& svg, Point corner, double width, double height, double share) {
  const double depth = std::sqrt(std::clamp(share, 0.0, 1.0));
  const auto channel = [&](double pale, double dark) { return std::lround(pale + depth * (dark - pale)); };
  svg.rectangle(
      corner, width - 2.0, height - 2.0,
      fmt::format("#{:02x}{:02x}{:02x}", channel(243.0, 27.0), channel(245.0, 94.0), channel(247.0, 158.0)));
  svg.text({corner.x + 0.5 * width - 1.0, corner.y + 0.5 * height + 3.5},
           fmt::format("{:.1f} %", 100.0 * share), {"middle", 11.5, depth > 0.55 ? "#ffffff" : "#2b2f36"});
}

// 1, 2 and 5 times the powers of ten within low..high, both above 0.
std::vector<double> logarithmic_ticks(double low, double high) {
  std::vector<double> ticks;
  for (double power = std::pow(10.0, std::floor(std::log10(low))); power <= high; power *= 10.0) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (factor * power >= low && factor * power <= high) ticks.push_back(factor * power);
    }
  }
  return ticks;
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
  const double legend = draw_legend(svg, chart.series);
  const std::vector<double> y_ticks =
      chart.logarithmic_y ? logarithmic_ticks(chart.y_low, y_high) : round_ticks(chart.y_low, y_high, 5);
  const Scale x{chart.x_low, chart.x_high, kLeft + 8.0, kRight - 8.0};
  const Scale y = chart.logarithmic_y ? Scale{chart.y_low, y_high, kBottom, kTop + legend, true}
                                      : Scale{y_ticks.front(), y_ticks.back(), kBottom, kTop + legend};
  draw_y_axis(svg, y, y_ticks, chart.y_label);
  std::vector<double> x_ticks = chart.x_ticks;
  const double x_step = std::max(1.0, std::ceil((chart.x_high - chart.x_low) / 12.0));
  if (x_ticks.empty()) {
    for (double tick = chart.x_low; tick <= chart.x_high; tick += x_step) x_ticks.push_back(tick);
  }
  draw_x_ticks(svg, x, x_ticks);
  draw_x_label(svg, chart.x_label);
  for (const Series& series : chart.series) draw_series(svg, x, y, series);
  return svg.text();
}

std::string bar_chart(const BarChart& chart) {
  Svg svg(kWidth, kHeight, chart.description);
  double highest = 1.0;
  for (const BarGroup& group : chart.groups) {
    for (const double value : group.values) highest = std::max(highest, value);
  }
  const std::vector<double> ticks = round_ticks(0.0, highest, 5);
  LegendRows legend;
  for (std::size_t i = 0; i < chart.series_names.size(); ++i) {
    const Point at = legend.place(chart.series_names[i], 20.0);
    svg.rectangle({at.x, at.y - 5.0}, 11.0, 11.0, chart.series_colours[i]);
    svg.text({at.x + 16.0, at.y + 4.0}, chart.series_names[i], {"start", 11.5, "#2b2f36"});
  }
  const Scale y{0.0, ticks.back(), kBottom, kTop + legend.height()};
  draw_y_axis(svg, y, ticks, chart.y_label);
  const double width = (kRight - kLeft) / static_cast<double>(std::max<std::size_t>(1, chart.groups.size()));
  for (std::size_t i = 0; i < chart.groups.size(); ++i) {
    draw_bar_group(svg, chart, y, chart.groups[i], kLeft + static_cast<double>(i) * width, width);
  }
  draw_x_label(svg, chart.x_label);
  return svg.text();
}

std::string agreement_chart(const AgreementChart& chart) {
  Svg svg(kWidth, kHeight, chart.description);
  const double top = kTop + draw_legend(svg, chart.series);
  const Scale x{chart.low, chart.high, kLeft, kRight, true};
  const Scale y{chart.low, chart.high, kBottom, top, true};
  std::vector<double> ticks;
  for (const double tick : {0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 90.0, 180.0}) {
    if (tick >= chart.low && tick <= chart.high) ticks.push_back(tick);
  }
  draw_y_axis(svg, y, ticks, chart.y_label);
  for (const double tick : ticks) svg.line({x(tick), top}, {x(tick), kBottom}, kGrid);
  draw_x_ticks(svg, x, ticks);
  draw_x_label(svg, chart.x_label);
  svg.line({x(chart.low), y(chart.low)}, {x(chart.high), y(chart.high)}, {"#8a9099", 1.2, "5 4", 1.0});
  for (const Series& series : chart.series) draw_series(svg, x, y, series);
  return svg.text();
}

std::string matrix_chart(const MatrixChart& chart) {
  constexpr double kNameWidth = 92.0;
  constexpr double kRemarkWidth = 88.0;
  constexpr double kRow = 27.0;
  const double cell = (kWidth - kNameWidth - kRemarkWidth) /
                      static_cast<double>(std::max<std::size_t>(1, chart.columns.size()));
  Svg svg(kWidth, 30.0 + kRow * static_cast<double>(chart.rows.size()), chart.description);
  const auto column_x = [&](std::size_t column) { return kNameWidth + cell * static_cast<double>(column); };
  for (std::size_t column = 0; column < chart.columns.size(); ++column) {
    svg.text({column_x(column) + 0.5 * cell, 18.0}, chart.columns[column], {"middle", 11.5, "#3c4149"});
  }
  svg.text({kWidth, 18.0}, chart.remark_heading, {"end", 11.5, "#3c4149"});
  for (std::size_t row = 0; row < chart.rows.size(); ++row) {
    const double y = 28.0 + kRow * static_cast<double>(row);
    svg.text({0.0, y + 17.0}, chart.rows[row].name, {"start", 11.5, "#2b2f36"});
    for (std::size_t column = 0; column < chart.rows[row].shares.size(); ++column) {
      draw_share(svg, {column_x(column), y}, cell, kRow, chart.rows[row].shares[column]);
    }
    svg.text({kWidth, y + 17.0}, chart.rows[row].remark, {"end", 11.5, "#2b2f36"});
  }
  return svg.text();
}

}  // namespace tumblesight::sim
