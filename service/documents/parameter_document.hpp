#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "service/documents/words.hpp"

/// What documents tell of parameters. Lengths are in mm, angles in rad.
namespace cell {

/// An error that another one carries, and by which factor.
struct CarriedError {
  std::string name;
  std::optional<double> factor;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("name", self.name);
    fields("factor", self.factor);
  }
};

/// A candidate of the kinematic model as a plan predicts it.
struct PlannedParameter {
  std::string name;
  int frame = 0;
  std::string kind;   // alpha, d, theta, r, beta
  std::string group;  // place, arm, tool
  std::string unit;
  std::optional<double> nominal;
  std::optional<calib::ParameterStatus> status;
  std::optional<double> std_uncertainty;
  std::vector<CarriedError> grouped_with;
  std::vector<CarriedError> stands_for;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    visit_with(
        self, fields, [](Fields&) {}, [](Fields&) {});
  }

  /// `error` and `interval` add the fields that only a result has, each in its place.
  template <class Self, class Fields, class Error, class Interval>
  static void visit_with(Self& self, Fields& fields, Error error, Interval interval) {
    fields("name", self.name);
    fields("frame", self.frame);
    fields("kind", self.kind);
    fields("group", self.group);
    fields("unit", self.unit);
    fields("nominal", self.nominal);
    fields("status", self.status);
    error(fields);
    fields("std_uncertainty", self.std_uncertainty);
    interval(fields);
    fields("grouped_with", self.grouped_with);
    fields("stands_for", self.stands_for);
  }
};

/// A candidate of the kinematic model with its error, in a result.
struct Parameter : PlannedParameter {
  std::optional<double> error;
  std::optional<std::array<std::optional<double>, 2>> interval95;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    visit_with(
        self, fields, [&self](Fields& more) { more("error", self.error); },
        [&self](Fields& more) { more("interval95", self.interval95); });
  }
};

/// What a plan predicts of a parameter of block, ball or probe.
struct PlannedArtefactParameter {
  std::string name;
  std::string unit;
  std::optional<double> nominal;
  std::optional<double> std_uncertainty;
  std::optional<ArtefactStatus> status;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    visit_with(self, fields, [](Fields&) {});
  }

  template <class Self, class Fields, class Value>
  static void visit_with(Self& self, Fields& fields, Value value) {
    fields("name", self.name);
    fields("unit", self.unit);
    fields("nominal", self.nominal);
    value(fields);
    fields("std_uncertainty", self.std_uncertainty);
    fields("status", self.status);
  }
};

/// A parameter of block, ball or probe, in a result.
struct ArtefactParameter : PlannedArtefactParameter {
  std::optional<double> value;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    visit_with(self, fields, [&self](Fields& more) { more("value", self.value); });
  }
};

/// Of two identified errors.
struct CorrelationOfErrors {
  std::string first;
  std::string second;
  std::optional<double> coefficient;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("first", self.first);
    fields("second", self.second);
    fields("coefficient", self.coefficient);
  }
};

/// What was estimated beside the 37 candidates.
struct NongeometricParameter {
  std::string name;  // "compliance2"
  std::string unit;  // "rad/Nm"
  std::optional<double> value;
  std::optional<double> std_uncertainty;
  ArtefactStatus status = ArtefactStatus::kPrior;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("name", self.name);
    fields("unit", self.unit);
    fields("value", self.value);
    fields("std_uncertainty", self.std_uncertainty);
    fields("status", self.status);
  }
};

struct JointCompliance {
  int joint = 0;  // from 1
  std::optional<double> compliance_rad_per_nm;
  std::optional<double> std_uncertainty;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("joint", self.joint);
    fields("compliance_rad_per_nm", self.compliance_rad_per_nm);
    fields("std_uncertainty", self.std_uncertainty);
  }
};

}  // namespace cell
