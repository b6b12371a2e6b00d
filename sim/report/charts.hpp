// Charts as inline SVG: lines, grouped bars and scatter on labelled axes, and matrices of shares.
#pragma once

#include <string>
#include <vector>

#include "sim/report/svg.hpp"

namespace tumblesight::sim {

struct Series {
  std::string name;
  std::string colour;
  std::string dash;                  // empty: solid
  std::vector<Point> points;         // in data units; a series of one point is drawn as a ring
  bool markers = false;              // dots instead of a line
  std::vector<double> error_bars{};  // half their length, one per point; empty: none
};

struct LineChart {
  std::string description;
  std::string x_label;
  std::string y_label;
  double x_low = 0.0;
  double x_high = 1.0;
  double y_low = 0.0;
  double y_high = 0.0;            // not above y_low: chosen from the data
  bool logarithmic_y = false;     // needs 0 < y_low < y_high
  std::vector<double> x_ticks{};  // empty: whole numbers from x_low
  std::vector<Series> series;
};

struct BarGroup {
  std::string name;
  std::vector<double> values;  // one per series
};

struct BarChart {
  std::string description;
  std::string x_label;
  std::string y_label;
  std::vector<std::string> series_names;
  std::vector<std::string> series_colours;
  std::vector<BarGroup> groups;
};

// Both axes are logarithmic from low to high, with the diagonal of equality. Points outside are drawn on the
// edge.
struct AgreementChart {
  std::string description;
  std::string x_label;
  std::string y_label;
  double low = 0.1;
  double high = 180.0;
  std::vector<Series> series;
};

// A matrix of shares; a darker cell is a larger share.
struct MatrixChart {
  std::string description;
  std::vector<std::string> columns;
  struct Row {
    std::string name;
    std::vector<double> shares;  // 0..1, one per column
    std::string remark;          // to the right of the cells
  };
  std::vector<Row> rows;
  std::string remark_heading;
};

std::string line_chart(const LineChart& chart);
std::string bar_chart(const BarChart& chart);
std::string agreement_chart(const AgreementChart& chart);
std::string matrix_chart(const MatrixChart& chart);

// About `count` round numbers that cover low..high, ascending.
std::vector<double> round_ticks(double low, double high, int count);

}  // namespace tumblesight::sim
