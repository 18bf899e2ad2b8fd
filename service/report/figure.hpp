#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

/// A plot of points in SVG, readable in print and without colour: series differ in their shape. No plotting
/// library: those for C++ on Debian 12 start a program (gnuplot) or a toolkit (Qt), which the daemon of a
/// cell does not have.
namespace cell {

enum class Mark { kRing, kDot, kCross };

struct Series {
  std::string name;
  Mark mark = Mark::kDot;
  std::vector<std::pair<double, double>> points;
  bool joined = false;  // by a line
};

struct Figure {
  std::string title;
  std::string x_label;  // of what is counted: ticked at whole numbers
  std::string y_label;
  std::vector<Series> series;
  std::optional<double> level;  // a horizontal line
  std::string level_name;
};

/// Where an axis from `low` to `high` (low < high, both finite) is ticked: multiples of 1, 2 or 5 times a
/// power of ten, three to eight of them.
std::vector<double> ticks(double low, double high);

/// The figure as one <svg> element; points that are not finite are left out.
std::string svg(const Figure& figure);

}  // namespace cell
