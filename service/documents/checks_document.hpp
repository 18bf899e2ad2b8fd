#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cell {

/// touchcal/checks/1 (service/doc/surfaces.md): the checks of one calibration, each figure as a chart from
/// check to check, and when the next one is due.
struct ChecksDocument {
  /// How many there are of those that something rests on.
  struct Count {
    int count = 0;
    int needed = 0;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("count", self.count);
      fields("needed", self.needed);
    }
  };
  struct Check {
    std::string run;
    std::string ended_at;  // RFC 3339
    std::optional<std::string> operator_name;
    bool reference = false;            // part of what the others are held against
    std::optional<bool> accepted;      // nothing: it has no verdict
    std::optional<std::string> cause;  // of an alarm, as in touchcal/check/1
    std::optional<int> joint;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("run", self.run);
      fields("ended_at", self.ended_at);
      fields("operator", self.operator_name);
      fields("reference", self.reference);
      fields("accepted", self.accepted);
      fields("cause", self.cause);
      fields("joint", self.joint);
    }
  };
  struct Point {
    std::string run;
    std::optional<double> value;
    std::optional<double> shewhart_limit;  // distance of the value from `centre`; nothing without limits
    std::optional<double> weighted_mean;   // these two: nothing either of a check that alarms
    std::optional<double> ewma_limit;      // distance of the weighted mean from `centre`
    bool beyond_shewhart = false;
    bool beyond_ewma = false;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("run", self.run);
      fields("value", self.value);
      fields("shewhart_limit", self.shewhart_limit);
      fields("weighted_mean", self.weighted_mean);
      fields("ewma_limit", self.ewma_limit);
      fields("beyond_shewhart", self.beyond_shewhart);
      fields("beyond_ewma", self.beyond_ewma);
    }
  };
  struct Chart {
    std::string quantity;  // joint_2 to joint_5, growth, residual
    std::string unit;      // mrad, ppm, mm
    std::optional<double> centre;
    std::vector<Point> points;  // oldest first

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("quantity", self.quantity);
      fields("unit", self.unit);
      fields("centre", self.centre);
      fields("points", self.points);
    }
  };

  std::string schema = "touchcal/checks/1";
  std::string of_run;
  int count = 0;  // of all its checks; `checks` and the charts have the newest of them
  Count reference;
  Count base;                         // of the charts: checks without an alarm
  std::optional<int> every_days;      // nothing: no rule, or the calibration was replaced
  std::optional<std::string> due_at;  // nothing with a rule: it is not known, the clock being wrong
  std::optional<bool> overdue;
  std::vector<std::string> warnings;  // what the newest check shows, one sentence each
  std::vector<Check> checks;          // oldest first
  std::vector<Chart> charts;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("of_run", self.of_run);
    fields("count", self.count);
    fields("reference", self.reference);
    fields("base", self.base);
    fields("every_days", self.every_days);
    fields("due_at", self.due_at);
    fields("overdue", self.overdue);
    fields("warnings", self.warnings);
    fields("checks", self.checks);
    fields("charts", self.charts);
  }
};

std::string document_text(const ChecksDocument& document);

/// DocumentError when the text is no such document.
ChecksDocument read_checks(std::string_view text);

}  // namespace cell
