#include "service/report/internal/figure.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "service/report/internal/html.hpp"

namespace cell {
namespace {

using html::element;
using html::escaped;

constexpr double kWidth = 360.0;
constexpr double kHeight = 220.0;
constexpr double kLeft = 58.0, kRight = 10.0, kTop = 24.0, kBottom = 52.0;
constexpr double kMarkRadius = 2.6;

struct Range {
  double low = 0.0;
  double high = 0.0;
  bool any = false;

  void take(double value) {
    low = any ? std::min(low, value) : value;
    high = any ? std::max(high, value) : value;
    any = true;
  }
  void take(const std::pair<double, double>& both) {
    take(both.first);
    take(both.second);
  }
  /// Adds a margin; an empty range gets a width.
  void widen() {
    const double width = high - low;
    const double room = width > 0.0 ? 0.06 * width : std::max(1e-3, 0.1 * std::abs(high));
    low -= room;
    high += room;
  }
  [[nodiscard]] double share(double value) const { return (value - low) / (high - low); }
};

bool is_finite(const std::pair<double, double>& point) {
  return std::isfinite(point.first) && std::isfinite(point.second);
}

struct Axes {
  Range x, y;

  [[nodiscard]] double px(double value) const { return kLeft + x.share(value) * (kWidth - kLeft - kRight); }
  [[nodiscard]] double py(double value) const {
    return kHeight - kBottom - y.share(value) * (kHeight - kTop - kBottom);
  }
};

Axes axes_of(const Figure& figure) {
  Axes axes;
  for (const Series& series : figure.series) {
    for (const auto& point : series.points) {
      if (!is_finite(point)) continue;
      axes.x.take(point.first);
      axes.y.take(point.second);
    }
  }
  if (figure.level) axes.y.take(*figure.level);
  if (figure.x_range) axes.x.take(*figure.x_range);
  if (figure.y_range) axes.y.take(*figure.y_range);
  axes.x.widen();
  axes.y.widen();
  return axes;
}

std::string line(double x1, double y1, double x2, double y2, const char* style) {
  return fmt::format(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" {}/>)", x1, y1, x2, y2, style);
}

std::string text(double x, double y, const char* anchor, const std::string& words, const char* more = "") {
  return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" {}>{}</text>)", x, y, anchor, more,
                     escaped(words));
}

std::string mark(Mark shape, double x, double y) {
  const double r = kMarkRadius;
  switch (shape) {
    case Mark::kRing:
      return fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{}" fill="none" stroke="#000"/>)", x, y, r);
    case Mark::kDot:
      return fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{}" fill="#000"/>)", x, y, r);
    case Mark::kCross:
      return fmt::format(R"(<path d="M{:.1f} {:.1f}l{} {}m0 -{}l-{} {}" stroke="#000" fill="none"/>)", x - r,
                         y - r, 2 * r, 2 * r, 2 * r, 2 * r, 2 * r);
  }
  return {};
}

/// As many decimals as the step between two ticks needs.
std::string tick_text(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
  return fmt::format("{:.{}f}", std::abs(value) < 1e-9 * step ? 0.0 : value, decimals);
}

std::string frame(const Words& words, const Figure& figure, const Axes& axes) {
  const double bottom = kHeight - kBottom;
  std::string drawn;
  auto across = ticks(axes.x.low, axes.x.high);
  std::erase_if(across, [](double value) { return std::abs(value - std::round(value)) > 1e-6; });
  const auto upwards = ticks(axes.y.low, axes.y.high);
  for (const double value : across) {
    drawn += line(axes.px(value), bottom, axes.px(value), bottom + 4, R"(stroke="#000")");
    drawn += text(axes.px(value), bottom + 15, "middle", fmt::format("{:.0f}", value));
  }
  for (const double value : upwards) {
    drawn += line(kLeft, axes.py(value), kWidth - kRight, axes.py(value), R"(stroke="#ddd")");
    drawn +=
        text(kLeft - 4, axes.py(value) + 3, "end", words.number(tick_text(value, upwards[1] - upwards[0])));
  }
  drawn += line(kLeft, kTop, kLeft, bottom, R"(stroke="#000")");
  drawn += line(kLeft, bottom, kWidth - kRight, bottom, R"(stroke="#000")");
  drawn += text(0.5 * kWidth, 13, "middle", figure.title, R"(font-weight="bold")");
  drawn += text(0.5 * (kLeft + kWidth - kRight), bottom + 29, "middle", figure.x_label);
  const double middle = 0.5 * (kTop + bottom);
  const std::string turn = fmt::format("transform=\"rotate(-90 12 {})\"", middle);
  return drawn + text(12, middle, "middle", figure.y_label, turn.c_str());
}

/// Of UTF-8: each character has one byte that does not go on with another.
double letters_of(const std::string& text) {
  return static_cast<double>(std::ranges::count_if(text, [](char each) { return (each & 0xC0) != 0x80; }));
}

std::string legend(const Figure& figure) {
  std::string drawn;
  double x = kLeft;
  const double y = kHeight - 7;
  constexpr double kLetter = 5.4;
  for (const Series& series : figure.series) {
    if (series.name.empty()) continue;
    drawn += mark(series.mark, x + 3, y - 3) + text(x + 10, y, "start", series.name);
    x += 22 + kLetter * letters_of(series.name);
  }
  if (!figure.level) return drawn;
  return drawn + line(x, y - 3, x + 14, y - 3, R"(stroke="#000" stroke-dasharray="4 3")") +
         text(x + 18, y, "start", figure.level_name);
}

}  // namespace

std::vector<double> ticks(double low, double high) {
  const double rough = (high - low) / 7.5;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * decade;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * decade >= rough) step = factor * decade;
  }
  std::vector<double> list;
  const double first = std::ceil(low / step - 1e-9);
  for (double i = first; i * step <= high + 1e-9 * step; i += 1.0) list.push_back(i * step);
  return list;
}

std::string svg(const Words& words, const Figure& figure) {
  const bool any = std::ranges::any_of(
      figure.series, [](const Series& series) { return std::ranges::any_of(series.points, is_finite); });
  if (!any) return html::paragraph(words("{}: there is nothing to show.", figure.title));
  const Axes axes = axes_of(figure);
  std::string drawn = frame(words, figure, axes);
  if (figure.level)
    drawn += line(kLeft, axes.py(*figure.level), kWidth - kRight, axes.py(*figure.level),
                  R"(stroke="#000" stroke-dasharray="4 3")");
  for (const Series& series : figure.series) {
    std::string way;
    for (const auto& point : series.points) {
      if (!is_finite(point)) continue;
      const double x = axes.px(point.first), y = axes.py(point.second);
      way += fmt::format("{:.1f},{:.1f} ", x, y);
      drawn += mark(series.mark, x, y);
    }
    if (series.joined) drawn += fmt::format(R"(<polyline points="{}" fill="none" stroke="#000"/>)", way);
  }
  return element("svg", element("title", escaped(figure.title)) + drawn + legend(figure),
                 fmt::format(R"(xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {} {}" role="img")", kWidth,
                             kHeight)) +
         "\n";
}

}  // namespace cell
