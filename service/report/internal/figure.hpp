#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "service/report/words/words.hpp"

/// A plot of points in SVG, readable in print without colour: series differ in their marks. No plotting
/// library: those for C++ on Debian 12 start a program (gnuplot) or need a toolkit (Qt), which a daemon
/// lacks.
namespace cell {

enum class Mark { kRing, kDot, kCross };

struct Series {
  std::string name;  // empty: not in the legend
  Mark mark = Mark::kDot;
  std::vector<std::pair<double, double>> points;
  bool joined = false;  // by a line
};

struct Figure {
  std::string title;
  std::string x_label;  // ticks at whole numbers
  std::string y_label;
  std::vector<Series> series;
  std::optional<double> level;  // a horizontal line
  std::string level_name;
  /// What the axes cover besides the points, so that figures have one scale.
  std::optional<std::pair<double, double>> x_range = {};
  std::optional<std::pair<double, double>> y_range = {};
};

/// Ticks of an axis from `low` to `high` (low < high, both finite): three to eight multiples of 1, 2 or 5
/// times a power of ten.
std::vector<double> ticks(double low, double high);

/// The figure as one <svg> element, its numbers in the form of the language; non-finite points are left out.
std::string svg(const Words& words, const Figure& figure);

}  // namespace cell
