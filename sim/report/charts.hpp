// Charts: lines, grouped bars, scatter on labelled axes, and tables of shares, as inline SVG.
#pragma once

#include <string>
#include <vector>

#include "sim/report/svg.hpp"

namespace tumblesight::sim {

struct Series {
  std::string name;
  std::string colour;
  std::string dash;                  // empty: solid
  std::vector<Point> points;         // data units; a series of one point is drawn as a mark
  bool markers = false;              // dots instead of a line
  std::vector<double> error_bars{};  // half their length, one a point; empty: none
};

struct LineChart {
  std::string description;
  std::string x_label;
  std::string y_label;
  double x_low = 0.0;
  double x_high = 1.0;
  double y_low = 0.0;
  double y_high = 0.0;            // not above y_low: chosen from the data
  std::vector<double> x_ticks{};  // empty: whole numbers from x_low
  std::vector<Series> series;
};

struct BarGroup {
  std::string name;
  std::vector<double> values;  // one a series
};

struct BarChart {
  std::string description;
  std::string x_label;
  std::string y_label;
  std::vector<std::string> series_names;
  std::vector<std::string> series_colours;
  std::vector<BarGroup> groups;
};

// Both axes logarithmic, low..high alike, with the diagonal of equality. Points outside are drawn on the
// edge.
struct AgreementChart {
  std::string description;
  std::string x_label;
  std::string y_label;
  double low = 0.1;
  double high = 180.0;
  std::vector<Series> series;
};

// A table of shares, the darker a cell the larger its share.
struct MatrixChart {
  std::string description;
  std::vector<std::string> columns;
  struct Row {
    std::string name;
    std::vector<double> shares;  // 0..1, one a column
    std::string remark;          // to the right of them
  };
  std::vector<Row> rows;
  std::string remark_heading;
};

std::string line_chart(const LineChart& chart);
std::string bar_chart(const BarChart& chart);
std::string agreement_chart(const AgreementChart& chart);
std::string matrix_chart(const MatrixChart& chart);

// Round numbers, about `count` of them, that cover low..high; ascending.
std::vector<double> round_ticks(double low, double high, int count);

}  // namespace tumblesight::sim
